// Compiled once per instruction set; Highway chooses among them at run time.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fiber_proximity/sim/effects.hpp"
#include "src/sim/edges.hpp"
#include "src/sim/require.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/effects/drag.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/sim/simd-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

/// Drag::Node, and how far it is from where the wind alone would bring it.
struct Node {
  Vector tangent;
  Vector lag;
  Real across;
  Real along;
};

HWY_INLINE Node node_at(const RodPack& rods, const NodeValues& values, std::size_t index,
                        std::size_t lane) {
  const SimdBatch* const first = &values[8 * index];
  return {load_vector(first, lane), position_at(rods, index, lane) - load_vector(first + 3, lane),
          load(first[6], lane), load(first[7], lane)};
}

void drag_energy(const RodPack& rods, const NodeValues& values, const double* /*constants*/,
                 SimdBatch& energy) {
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    Real sum = real(0.0);
    for (std::size_t i = 0; i < rods.node_count; ++i) {
      const Node node = node_at(rods, values, i, lane);
      const Real along = dot(node.tangent, node.lag);
      sum =
          sum + node.across * dot(node.lag, node.lag) + (node.along - node.across) * along * along;
    }
    store(real(0.5) * sum, energy, lane);
  }
}

template <std::size_t U>
void add_drag_of(const RodPack& rods, const NodeValues& values, PackSystem& system) {
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    for (std::size_t i = 0; i < rods.node_count; ++i) {
      const Node node = node_at(rods, values, i, lane);
      const Vector more = (node.along - node.across) * node.tangent;
      add_gradient<U>(node.across * node.lag + dot(node.tangent, node.lag) * more, i, lane, system);
      add_diagonal<U>(block_of(node.across, more, node.tangent), i, lane, system);
    }
  }
}

void add_drag(const RodPack& rods, const NodeValues& values, const double* /*constants*/,
              PackSystem& system) {
  with_unknowns(system, [&](auto u) { add_drag_of<u>(rods, values, system); });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

using Eigen::Vector3d;

HWY_EXPORT(drag_energy);
HWY_EXPORT(add_drag);

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
  const bool is_seam = rods.is_closed(rod) && (node == first || node == last);
  const std::uint32_t before = is_seam ? last - 1 : std::max(node, first + 1) - 1;
  const std::uint32_t after = is_seam ? first + 1 : std::min(node + 1, last);
  const Vector3d tangent = direction_of(rods.positions[after] - rods.positions[before]).tangent;
  const double length =
      0.5 * ((node > first ? rods.rest_lengths[node - 1] : 0.0) + rods.rest_lengths[node]);
  const Vector3d wind = options_.wind.at(position, step.end());
  const Vector3d relative = wind - rods.velocities[node];
  const double along = tangent.dot(relative);
  const double across = (relative - along * tangent).norm();
  const double area =
      rods.edge_radii.empty()
          ? 2.0 * rods.radii[rod] * length
          : (node > first ? rods.rest_lengths[node - 1] * rods.edge_radii[node - 1] : 0.0) +
                rods.rest_lengths[node] * rods.edge_radii[node];
  const double scale = 0.5 * options_.fluid_density * area / step.length;
  return {tangent, position + step.length * wind, scale * options_.across * across,
          scale * options_.along * std::abs(along)};
}

void Drag::begin_step(Rods& rods, const TimeStep& step) {
  static_assert(sizeof(Node) == 8 * sizeof(double), "as per_node_data() has them");
  nodes_.resize(rods.positions.size());
  tbb::parallel_for(std::uint32_t{0}, rods.count(), [&](std::uint32_t rod) {
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      nodes_[i] = node_at(rods, rod, i, step);
    }
  });
}

LaneEffect::Kernels Drag::kernels() const {
  return {&HWY_DYNAMIC_DISPATCH(drag_energy), &HWY_DYNAMIC_DISPATCH(add_drag)};
}

}  // namespace fiber
#endif
