// Compiled once per instruction set; Highway chooses among them at run time.
#include "fiber_proximity/sim/effects/damping.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/effects/damping_lanes.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <limits>

#include "src/sim/edge_pair-inl.hpp"
#include "src/sim/frames-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

/// How much longer an edge is than when the step began.
HWY_INLINE Real lengthening(const RodLanes& rods, const std::vector<Lanes>& starts,
                            std::size_t edge, std::size_t lane) {
  return load(rods.lengths[edge], lane) - load(starts[7 * edge + 6], lane);
}

/// What has changed of a node's turn since then, apart from rigid rotation.
struct TurnChange {
  TwoEdges edges;
  Vector turn;
  Vector change;
  Vector old_middle;
  Vector middle;       // of the tangents, of unit length
  Real middle_length;  // before that
  Real stiffness;      // 0 where it was folded and had no middle
};

/// @param total stiffness of the rod against bending, and this much of it resists the change
HWY_INLINE TurnChange turn_change(const RodLanes& rods, const std::vector<Lanes>& starts,
                                  Real total, std::size_t node, std::size_t lane) {
  const Lanes* const start = &starts[7 * node];
  const Real least = real(std::numeric_limits<double>::min());
  TurnChange result;
  result.edges = edges_beside(rods, node, lane);
  result.turn = result.edges.after - result.edges.before;
  const Vector sum = result.edges.before + result.edges.after;
  result.middle_length = square_root(dot(sum, sum));
  result.middle = real(1.0) / larger(result.middle_length, least) * sum;
  result.old_middle = load_vector(start + 3, lane);
  result.change =
      result.turn - transport(load_vector(start, lane), result.old_middle, result.middle);
  const auto had_middle = hn::Gt(dot(result.old_middle, result.old_middle).value, real(0.0).value);
  const Real stiffness = total * load(rods.inverse_node_lengths[node], lane);
  result.stiffness = {hn::IfThenElseZero(had_middle, stiffness.value)};
  return result;
}

/// The gradient of the change's energy by either tangent, as far as they turn the middle, which
/// takes the old turn along.
HWY_INLINE Vector by_middle(const TurnChange& turn) {
  constexpr double folded = 1e-3;  // as in Damping
  const Real rotated = dot(turn.middle, cross(turn.change, turn.turn));
  const Real factor =
      real(-0.5) * turn.stiffness * rotated / larger(real(folded), turn.middle_length);
  return factor * curvature_binormal(turn.old_middle, turn.middle);
}

void energy(const RodLanes& rods, const std::vector<Lanes>& starts, double share, Lanes& energy) {
  const Real one = real(1.0);
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
    Real stretch = real(0.0);
    Real bend = real(0.0);
    for (std::size_t i = 0; i + 1 < rods.node_count; ++i) {
      const Real longer = lengthening(rods, starts, i, lane);
      stretch = stretch + longer * longer * load(rods.inverse_rest_lengths[i], lane);
      if (i > 0) {
        const TurnChange turn = turn_change(rods, starts, one, i, lane);
        bend = bend + turn.stiffness * dot(turn.change, turn.change);
      }
    }
    const Real sum =
        load(rods.stretching_stiffness, lane) * stretch + load(rods.bending_stiffness, lane) * bend;
    store(real(0.5 * share) * sum, energy, lane);
  }
}

template <std::size_t U>
void add_derivatives_of(const RodLanes& rods, const std::vector<Lanes>& starts, double share,
                        LaneSystem& system) {
  const Real zero = real(0.0);
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
    const Real stretching = real(share) * load(rods.stretching_stiffness, lane);
    const Real bending = real(share) * load(rods.bending_stiffness, lane);
    for (std::size_t i = 0; i + 1 < rods.node_count; ++i) {
      const Vector tangent = tangent_at(rods, i, lane);
      const Vector along = stretching * load(rods.inverse_rest_lengths[i], lane) * tangent;
      const Vector force = lengthening(rods, starts, i, lane) * along;
      add_edge<U>(force, block_of(zero, along, tangent), i, lane, system);
      if (i > 0) {
        const TurnChange turn = turn_change(rods, starts, bending, i, lane);
        const Vector by_turn = turn.stiffness * turn.change;
        const Vector by_both = by_middle(turn);
        add_gradient<U>(turn.edges, by_both - by_turn, by_both + by_turn, i, lane, system);
        add_hessian<U>(isotropic_blocks(turn.edges, turn.stiffness), i, lane, system);
      }
    }
  }
}

void add_derivatives(const RodLanes& rods, const std::vector<Lanes>& starts, double share,
                     LaneSystem& system) {
  system.unknowns == 3 ? add_derivatives_of<3>(rods, starts, share, system)
                       : add_derivatives_of<4>(rods, starts, share, system);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(energy);
HWY_EXPORT(add_derivatives);

void Damping::energy_in_lanes(const RodLanes& rods, const std::vector<Lanes>& values,
                              Lanes& energy) const {
  HWY_DYNAMIC_DISPATCH(energy)(rods, values, share_, energy);
}

void Damping::add_derivatives_in_lanes(const RodLanes& rods, const std::vector<Lanes>& values,
                                       LaneSystem& system) const {
  HWY_DYNAMIC_DISPATCH(add_derivatives)(rods, values, share_, system);
}

}  // namespace fiber
#endif
