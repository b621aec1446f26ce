// Compiled once per instruction set; Highway chooses among them at run time.
#include "fiber_proximity/sim/effects/stretch.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/effects/stretch_lanes.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/sim/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

void energy(const RodLanes& rods, Lanes& energy) {
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
    Real sum = real(0.0);
    for (std::size_t i = 0; i + 1 < rods.node_count; ++i) {
      const Real excess = load(rods.lengths[i], lane) - load(rods.rest_lengths[i], lane);
      sum = sum + excess * excess * load(rods.inverse_rest_lengths[i], lane);
    }
    store(real(0.5) * load(rods.stretching_stiffness, lane) * sum, energy, lane);
  }
}

template <std::size_t U>
void add_derivatives_of(const RodLanes& rods, LaneSystem& system) {
  const Real zero = real(0.0);
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
    const Real total = load(rods.stretching_stiffness, lane);
    for (std::size_t i = 0; i + 1 < rods.node_count; ++i) {
      const Real stiffness = total * load(rods.inverse_rest_lengths[i], lane);
      const Real excess = load(rods.lengths[i], lane) - load(rods.rest_lengths[i], lane);
      const Vector tangent = tangent_at(rods, i, lane);
      const Vector force = stiffness * excess * tangent;
      // Under pressure an edge gives way sideways; that part is negative definite and left out.
      const Real sideways = stiffness * larger(zero, excess * load(rods.inverse_lengths[i], lane));
      const Vector along = (stiffness - sideways) * tangent;
      add_edge<U>(force, block_of(sideways, along, tangent), i, lane, system);
    }
  }
}

void add_derivatives(const RodLanes& rods, LaneSystem& system) {
  system.unknowns == 3 ? add_derivatives_of<3>(rods, system) : add_derivatives_of<4>(rods, system);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(energy);
HWY_EXPORT(add_derivatives);

void Stretch::energy_in_lanes(const RodLanes& rods, const std::vector<Lanes>& /*values*/,
                              Lanes& energy) const {
  HWY_DYNAMIC_DISPATCH(energy)(rods, energy);
}

void Stretch::add_derivatives_in_lanes(const RodLanes& rods, const std::vector<Lanes>& /*values*/,
                                       LaneSystem& system) const {
  HWY_DYNAMIC_DISPATCH(add_derivatives)(rods, system);
}

}  // namespace fiber
#endif
