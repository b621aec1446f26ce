// Compiled once per instruction set; Highway chooses among them at run time.
#include "fiber_proximity/sim/effects/drag.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/effects/drag_lanes.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/sim/lanes-inl.hpp"

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

HWY_INLINE Node node_at(const RodLanes& rods, const std::vector<Lanes>& values, std::size_t index,
                        std::size_t lane) {
  const Lanes* const first = &values[8 * index];
  return {load_vector(first, lane), position_at(rods, index, lane) - load_vector(first + 3, lane),
          load(first[6], lane), load(first[7], lane)};
}

void energy(const RodLanes& rods, const std::vector<Lanes>& values, Lanes& energy) {
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
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
void add_derivatives_of(const RodLanes& rods, const std::vector<Lanes>& values,
                        LaneSystem& system) {
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
    for (std::size_t i = 0; i < rods.node_count; ++i) {
      const Node node = node_at(rods, values, i, lane);
      const Vector more = (node.along - node.across) * node.tangent;
      add_gradient<U>(node.across * node.lag + dot(node.tangent, node.lag) * more, i, lane, system);
      add_diagonal<U>(block_of(node.across, more, node.tangent), i, lane, system);
    }
  }
}

void add_derivatives(const RodLanes& rods, const std::vector<Lanes>& values, LaneSystem& system) {
  system.unknowns == 3 ? add_derivatives_of<3>(rods, values, system)
                       : add_derivatives_of<4>(rods, values, system);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(energy);
HWY_EXPORT(add_derivatives);

void Drag::energy_in_lanes(const RodLanes& rods, const std::vector<Lanes>& values,
                           Lanes& energy) const {
  HWY_DYNAMIC_DISPATCH(energy)(rods, values, energy);
}

void Drag::add_derivatives_in_lanes(const RodLanes& rods, const std::vector<Lanes>& values,
                                    LaneSystem& system) const {
  HWY_DYNAMIC_DISPATCH(add_derivatives)(rods, values, system);
}

}  // namespace fiber
#endif
