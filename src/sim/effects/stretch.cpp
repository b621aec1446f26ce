// Compiled once per instruction set; Highway chooses among them at run time.
#include "fiber_proximity/sim/effects/stretch.hpp"

#include "fiber_proximity/sim/forces.hpp"
#include "src/sim/pack_lane.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/effects/stretch.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/sim/simd-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

void energy(const RodPack& rods, SimdBatch& energy) {
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    Real sum = real(0.0);
    for (std::size_t i = 0; i + 1 < rods.node_count; ++i) {
      const Real excess = load(rods.lengths[i], lane) - load(rods.rest_lengths[i], lane);
      sum = sum + excess * excess * load(rods.inverse_rest_lengths[i], lane);
    }
    store(real(0.5) * load(rods.stretching_stiffness, lane) * sum, energy, lane);
  }
}

template <std::size_t U>
void add_derivatives_of(const RodPack& rods, PackSystem& system) {
  const Real zero = real(0.0);
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
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

void add_derivatives(const RodPack& rods, PackSystem& system) {
  with_unknowns(system, [&](auto u) { add_derivatives_of<u>(rods, system); });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(energy);
HWY_EXPORT(add_derivatives);

void Stretch::energy(const RodPack& rods, const std::vector<SimdBatch>& /*values*/,
                     SimdBatch& energy) const {
  HWY_DYNAMIC_DISPATCH(energy)(rods, energy);
}

void Stretch::add_derivatives(const RodPack& rods, const std::vector<SimdBatch>& /*values*/,
                              PackSystem& system) const {
  HWY_DYNAMIC_DISPATCH(add_derivatives)(rods, system);
}

void Stretch::add_forces(const RodPack& rods, const std::vector<SimdBatch>& /*values*/,
                         RodForces& forces) const {
  for_each_edge(rods, [&](const PackLane& rod, std::uint32_t edge, std::uint32_t index) {
    const double strain = rod.direction(edge).length / rod.rest_length(edge) - 1.0;
    forces.tensions[index] += rod.stretching_stiffness() * strain;
  });
}

}  // namespace fiber
#endif
