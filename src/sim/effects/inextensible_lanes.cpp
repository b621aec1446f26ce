// Compiled once per instruction set; Highway chooses among them at run time.
#include "fiber_proximity/sim/effects/inextensible.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/effects/inextensible_lanes.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/sim/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

/// Inextensible::Spring, and by how much it is too long.
struct Spring {
  Real tension;
  Real stiffness;
  Real excess;
};

HWY_INLINE Spring spring_at(const RodLanes& rods, const std::vector<Lanes>& values,
                            std::size_t edge, std::size_t lane) {
  return {load(values[2 * edge], lane), load(values[2 * edge + 1], lane),
          load(rods.lengths[edge], lane) - load(rods.rest_lengths[edge], lane)};
}

void energy(const RodLanes& rods, const std::vector<Lanes>& values, Lanes& energy) {
  const Real half = real(0.5);
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
    Real sum = real(0.0);
    for (std::size_t i = 0; i + 1 < rods.node_count; ++i) {
      const Spring spring = spring_at(rods, values, i, lane);
      sum = sum + (spring.tension + half * spring.stiffness * spring.excess) * spring.excess;
    }
    store(sum, energy, lane);
  }
}

template <std::size_t U>
void add_derivatives_of(const RodLanes& rods, const std::vector<Lanes>& values,
                        LaneSystem& system) {
  const Real zero = real(0.0);
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
    for (std::size_t i = 0; i + 1 < rods.node_count; ++i) {
      const Spring spring = spring_at(rods, values, i, lane);
      const Vector tangent = tangent_at(rods, i, lane);
      const Real force = spring.tension + spring.stiffness * spring.excess;
      // As in Stretch, without what gives way under pressure.
      const Real sideways = larger(zero, force) * load(rods.inverse_lengths[i], lane);
      const Vector along = (spring.stiffness - sideways) * tangent;
      add_edge<U>(force * tangent, block_of(sideways, along, tangent), i, lane, system);
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

void Inextensible::energy_in_lanes(const RodLanes& rods, const std::vector<Lanes>& values,
                                   Lanes& energy) const {
  HWY_DYNAMIC_DISPATCH(energy)(rods, values, energy);
}

void Inextensible::add_derivatives_in_lanes(const RodLanes& rods, const std::vector<Lanes>& values,
                                            LaneSystem& system) const {
  HWY_DYNAMIC_DISPATCH(add_derivatives)(rods, values, system);
}

}  // namespace fiber
#endif
