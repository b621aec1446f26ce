#include "fiber_proximity/sim/effects/drag.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "../require.hpp"
#include "fiber_proximity/sim/edge_pair.hpp"

namespace fiber {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d WindField::at(const Vector3d& point, double time) const {
  if (gust.isZero(0.0)) {
    return mean;
  }
  const Vector3d direction = direction_of(mean).tangent;
  const double phase = 2.0 * M_PI * (time / gust_period - direction.dot(point) / gust_length);
  return mean + gust * std::sin(phase);
}

Drag::Drag(const Options& options) : options_(options) {
  require_not_negative("drag: fluid_density", options.fluid_density);
  require_not_negative("drag: across", options.across);
  require_not_negative("drag: along", options.along);
  require_positive("drag: gust_period", options.wind.gust_period);
  require_positive("drag: gust_length", options.wind.gust_length);
  if (!options.wind.mean.allFinite() || !options.wind.gust.allFinite()) {
    throw std::invalid_argument("drag: the wind must be finite");
  }
}

Drag::Node Drag::node_at(const Rods& rods, std::uint32_t rod, std::uint32_t node,
                         const TimeStep& step) const {
  const std::uint32_t first = rods.first(rod);
  const std::uint32_t last = rods.end(rod) - 1;
  const Vector3d& position = rods.positions[node];
  const Vector3d tangent = direction_of(rods.positions[std::min(node + 1, last)] -
                                        rods.positions[std::max(node, first + 1) - 1])
                               .tangent;
  const double length =
      0.5 * ((node > first ? rods.rest_lengths[node - 1] : 0.0) + rods.rest_lengths[node]);
  const Vector3d wind = options_.wind.at(position, step.end());
  const Vector3d relative = wind - rods.velocities[node];
  const double along = tangent.dot(relative);
  const double across = (relative - along * tangent).norm();
  const double area = 2.0 * rods.radii[rod] * length;
  const double scale = 0.5 * options_.fluid_density * area / step.length;
  return {tangent, position + step.length * wind, scale * options_.across * across,
          scale * options_.along * std::abs(along)};
}

void Drag::begin_step(Rods& rods, const TimeStep& step) {
  nodes_.resize(rods.positions.size());
  tbb::parallel_for(std::uint32_t{0}, rods.count(), [&](std::uint32_t rod) {
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      nodes_[i] = node_at(rods, rod, i, step);
    }
  });
}

double Drag::energy(const Rods& rods, std::uint32_t rod) const {
  double energy = 0.0;
  for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
    const Node& node = nodes_[i];
    const Vector3d lag = rods.positions[i] - node.carried;
    const double along = node.tangent.dot(lag);
    energy += node.across * lag.squaredNorm() + (node.along - node.across) * along * along;
  }
  return 0.5 * energy;
}

void Drag::add_derivatives(const Rods& rods, std::uint32_t rod, RodSystem& system) const {
  const std::uint32_t first = rods.first(rod);
  for (std::uint32_t i = first; i < rods.end(rod); ++i) {
    const Node& node = nodes_[i];
    const Matrix3d resistance = node.across * Matrix3d::Identity() + (node.along - node.across) *
                                                                         node.tangent *
                                                                         node.tangent.transpose();
    system.add_gradient(i - first, resistance * (rods.positions[i] - node.carried));
    system.add_hessian(i - first, resistance);
  }
}

const double* Drag::values_of(std::uint32_t node) const {
  static_assert(sizeof(Node) == 8 * sizeof(double));
  return nodes_[node].tangent.data();
}

}  // namespace fiber
