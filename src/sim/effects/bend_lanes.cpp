// Compiled once per instruction set; Highway chooses among them at run time.
#include "fiber_proximity/sim/effects/bend.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/effects/bend_lanes.cpp"
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
    Vector before = tangent_at(rods, 0, lane);
    for (std::size_t i = 1; i + 1 < rods.node_count; ++i) {
      const Vector after = tangent_at(rods, i, lane);
      const Vector turn = after - before;
      sum = sum + dot(turn, turn) * load(rods.inverse_node_lengths[i], lane);
      before = after;
    }
    store(real(0.5) * load(rods.bending_stiffness, lane) * sum, energy, lane);
  }
}

/// EdgePair::add_derivatives() with an energy of the turn's square.
template <std::size_t U>
void add_derivatives_of(const RodLanes& rods, LaneSystem& system) {
  const Real one = real(1.0);
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
    const Real total = load(rods.bending_stiffness, lane);
    for (std::size_t i = 1; i + 1 < rods.node_count; ++i) {
      const Real stiffness = total * load(rods.inverse_node_lengths[i], lane);
      const Vector a = tangent_at(rods, i - 1, lane);
      const Vector b = tangent_at(rods, i, lane);
      const Real inverse_a = load(rods.inverse_lengths[i - 1], lane);
      const Real inverse_b = load(rods.inverse_lengths[i], lane);
      const Vector turn = b - a;
      const Vector on_a = stiffness * inverse_a * (dot(a, turn) * a - turn);
      const Vector on_b = stiffness * inverse_b * (turn - dot(b, turn) * b);
      add_gradient<U>(negative(on_a), i - 1, lane, system);
      add_gradient<U>(on_a - on_b, i, lane, system);
      add_gradient<U>(on_b, i + 1, lane, system);

      const Real cosine = dot(a, b);
      const Real of_first = stiffness * inverse_a * inverse_a;
      const Real of_last = stiffness * inverse_b * inverse_b;
      const Real of_cross = stiffness * inverse_a * inverse_b;
      Block first;
      Block last;
      Block cross;
      for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 3; ++c) {
          const Real aa = r == c ? one - a.of[r] * a.of[c] : negative(a.of[r] * a.of[c]);
          const Real bb = b.of[r] * b.of[c];
          first.of[r][c] = of_first * aa;
          last.of[r][c] = of_last * (r == c ? one - bb : negative(bb));
          cross.of[r][c] = of_cross * (aa - bb + b.of[r] * (cosine * a.of[c]));
        }
      }
      Block middle;
      Block below_first;
      Block above_last;
      for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 3; ++c) {
          below_first.of[r][c] = negative(first.of[r][c] + cross.of[r][c]);
          above_last.of[r][c] = negative(last.of[r][c] + cross.of[r][c]);
          middle.of[r][c] = first.of[r][c] + last.of[r][c] + cross.of[r][c] + cross.of[c][r];
        }
      }
      add_diagonal<U>(first, i - 1, lane, system);
      add_below<U>(below_first, i - 1, 1, lane, system);
      add_below<U>(cross, i - 1, 2, lane, system);
      add_diagonal<U>(middle, i, lane, system);
      add_below<U>(above_last, i, 1, lane, system);
      add_diagonal<U>(last, i + 1, lane, system);
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

void Bend::energy_in_lanes(const RodLanes& rods, const std::vector<Lanes>& /*values*/,
                           Lanes& energy) const {
  HWY_DYNAMIC_DISPATCH(energy)(rods, energy);
}

void Bend::add_derivatives_in_lanes(const RodLanes& rods, const std::vector<Lanes>& /*values*/,
                                    LaneSystem& system) const {
  HWY_DYNAMIC_DISPATCH(add_derivatives)(rods, system);
}

}  // namespace fiber
#endif
