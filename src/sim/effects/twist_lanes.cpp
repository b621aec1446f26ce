// Compiled once per instruction set; Highway chooses among them at run time.
#include <cassert>

#include "fiber_proximity/sim/effects/twist.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/effects/twist_lanes.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/sim/frames-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

constexpr std::size_t unknowns = 4;

/// @param references what Twist keeps of the nodes
HWY_INLINE Real twist_at(const RodLanes& rods, const std::vector<Lanes>& references,
                         std::size_t node, std::size_t lane) {
  return angle_at(rods, node, lane) - angle_at(rods, node - 1, lane) +
         nearest_turn(load(rods.director_twists[node], lane), load(references[node], lane));
}

void energy(const RodLanes& rods, const std::vector<Lanes>& references, Lanes& energy) {
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
    Real sum = real(0.0);
    for (std::size_t i = 1; i + 1 < rods.node_count; ++i) {
      const Real twist = twist_at(rods, references, i, lane);
      sum = sum + twist * twist * load(rods.inverse_node_lengths[i], lane);
    }
    store(real(0.5) * load(rods.twisting_stiffness, lane) * sum, energy, lane);
  }
}

/// The derivative of the twist at a node by all unknowns from the previous node to the next one.
struct TwistDerivative {
  static constexpr std::size_t size = 2 * unknowns + 3;
  Real of[size];
};

HWY_INLINE TwistDerivative derivative_at(const RodLanes& rods, std::size_t node, std::size_t lane) {
  const Vector binormal =
      curvature_binormal(tangent_at(rods, node - 1, lane), tangent_at(rods, node, lane));
  const Real half = real(0.5);
  const Vector by_previous = director_turn(rods, node - 1, lane) -
                             half * load(rods.inverse_lengths[node - 1], lane) * binormal;
  const Vector by_next =
      director_turn(rods, node, lane) + half * load(rods.inverse_lengths[node], lane) * binormal;
  TwistDerivative derivative;
  for (std::size_t k = 0; k < 3; ++k) {
    derivative.of[k] = by_previous.of[k];
    derivative.of[unknowns + k] = negative(by_previous.of[k] + by_next.of[k]);
    derivative.of[2 * unknowns + k] = by_next.of[k];
  }
  derivative.of[3] = real(-1.0);
  derivative.of[unknowns + 3] = real(1.0);
  return derivative;
}

void add_derivatives(const RodLanes& rods, const std::vector<Lanes>& references,
                     LaneSystem& system) {
  assert(system.unknowns == unknowns);
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
    const Real total = load(rods.twisting_stiffness, lane);
    for (std::size_t i = 1; i + 1 < rods.node_count; ++i) {
      const Real stiffness = total * load(rods.inverse_node_lengths[i], lane);
      const Real moment = stiffness * twist_at(rods, references, i, lane);
      const TwistDerivative derivative = derivative_at(rods, i, lane);
      const std::size_t start = unknowns * (i - 1);
      Lanes* const gradient = &system.gradient[start];
      Lanes* const hessian = &system.hessian[start * column_height<unknowns>];
      for (std::size_t c = 0; c < TwistDerivative::size; ++c) {
        add(moment * derivative.of[c], gradient[c], lane);
        const Real scaled = stiffness * derivative.of[c];
        for (std::size_t r = c; r < TwistDerivative::size; ++r) {
          add(scaled * derivative.of[r], hessian[c * column_height<unknowns> + r - c], lane);
        }
      }
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(energy);
HWY_EXPORT(add_derivatives);

void Twist::energy_in_lanes(const RodLanes& rods, const std::vector<Lanes>& values,
                            Lanes& energy) const {
  HWY_DYNAMIC_DISPATCH(energy)(rods, values, energy);
}

void Twist::add_derivatives_in_lanes(const RodLanes& rods, const std::vector<Lanes>& values,
                                     LaneSystem& system) const {
  HWY_DYNAMIC_DISPATCH(add_derivatives)(rods, values, system);
}

}  // namespace fiber
#endif
