#include "fiber_proximity/sim/effects/drag.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "../require.hpp"
#include "fiber_proximity/sim/edge_pair.hpp"

namespace fiber {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d WindField::at(const Vector3d& point, double time) const {
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

void Drag::begin_step(Rods& rods, const TimeStep& step) {
  resistances_.resize(rods.positions.size());
  carried_.resize(rods.positions.size());
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    const std::uint32_t first = rods.first(rod);
    const std::uint32_t last = rods.end(rod) - 1;
    for (std::uint32_t i = first; i <= last; ++i) {
      const Vector3d& position = rods.positions[i];
      const Vector3d tangent = direction_of(rods.positions[std::min(i + 1, last)] -
                                            rods.positions[std::max(i, first + 1) - 1])
                                   .tangent;
      const double length =
          0.5 * ((i > first ? rods.rest_lengths[i - 1] : 0.0) + rods.rest_lengths[i]);
      const Vector3d wind = options_.wind.at(position, step.end());
      const Vector3d relative = wind - rods.velocities[i];
      const double along = tangent.dot(relative);
      const double across = (relative - along * tangent).norm();
      const double area = 2.0 * rods.radii[rod] * length;
      const double scale = 0.5 * options_.fluid_density * area / step.length;
      const Matrix3d tangential = tangent * tangent.transpose();
      resistances_[i] = scale * (options_.across * across * (Matrix3d::Identity() - tangential) +
                                 options_.along * std::abs(along) * tangential);
      carried_[i] = position + step.length * wind;
    }
  }
}

double Drag::energy(const Rods& rods, std::uint32_t rod) const {
  double energy = 0.0;
  for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
    const Vector3d lag = rods.positions[i] - carried_[i];
    energy += 0.5 * lag.dot(resistances_[i] * lag);
  }
  return energy;
}

void Drag::add_derivatives(const Rods& rods, std::uint32_t rod, RodSystem& system) const {
  const std::uint32_t first = rods.first(rod);
  for (std::uint32_t i = first; i < rods.end(rod); ++i) {
    system.add_gradient(i - first, resistances_[i] * (rods.positions[i] - carried_[i]));
    system.add_hessian(i - first, resistances_[i]);
  }
}

}  // namespace fiber
