// Compiled once per instruction set; Highway chooses among them at run time.
#include "fiber_proximity/sim/effects.hpp"
#include "fiber_proximity/sim/forces.hpp"
#include "src/sim/edges.hpp"
#include "src/sim/require.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/effects/damping.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <limits>

#include "src/sim/simd-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

/// The lengthening of an edge since the step began.
HWY_INLINE Real lengthening(const RodPack& rods, const NodeValues& starts, std::size_t edge,
                            std::size_t lane) {
  return load(rods.lengths[edge], lane) - load(starts[7 * edge + 6], lane);
}

/// The change of a node's turn since the step began, apart from rigid rotation.
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
HWY_INLINE TurnChange turn_change(const RodPack& rods, const NodeValues& starts, Real total,
                                  std::size_t node, std::size_t lane) {
  const SimdBatch* const start = &starts[7 * node];
  const Real smallest = real(std::numeric_limits<double>::min());
  TurnChange result;
  result.edges = edges_beside(rods, node, lane);
  result.turn = result.edges.after - result.edges.before;
  const Vector sum = result.edges.before + result.edges.after;
  result.middle_length = hn::Sqrt(dot(sum, sum));
  result.middle = real(1.0) / hn::Max(result.middle_length, smallest) * sum;
  result.old_middle = load_vector(start + 3, lane);
  result.change =
      result.turn - transport(load_vector(start, lane), result.old_middle, result.middle);
  const auto had_middle = hn::Gt(dot(result.old_middle, result.old_middle), real(0.0));
  const Real stiffness = total * load(rods.inverse_node_lengths[node], lane);
  result.stiffness = hn::IfThenElseZero(had_middle, stiffness);
  return result;
}

/// The gradient of the change's energy by either tangent, as far as they turn the middle, which
/// takes the old turn along.
HWY_INLINE Vector by_middle(const TurnChange& turn) {
  constexpr double folded = 1e-3;  // as in Damping
  const Real rotated = dot(turn.middle, cross(turn.change, turn.turn));
  const Real factor =
      real(-0.5) * turn.stiffness * rotated / hn::Max(real(folded), turn.middle_length);
  return factor * curvature_binormal(turn.old_middle, turn.middle);
}

void energy(const RodPack& rods, const NodeValues& starts, const double* share, SimdBatch& energy) {
  const Real one = real(1.0);
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
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
    store(real(0.5 * *share) * sum, energy, lane);
  }
}

template <std::size_t U>
void add_derivatives_of(const RodPack& rods, const NodeValues& starts, double share,
                        PackSystem& system) {
  const Real zero = real(0.0);
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
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

void add_derivatives(const RodPack& rods, const NodeValues& starts, const double* share,
                     PackSystem& system) {
  with_unknowns(system, [&](auto u) { add_derivatives_of<u>(rods, starts, *share, system); });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(energy);
HWY_EXPORT(add_derivatives);

using Eigen::Vector3d;

Damping::Damping(double relaxation_time) : relaxation_time_(relaxation_time) {
  require_not_negative("damping: the relaxation time", relaxation_time, " s");
}

/// Below this length of the sum of two tangents a rod is folded, and has no frame to compare its
/// turns in.
constexpr double min_middle = 1e-3;

void Damping::begin_step(Rods& rods, const TimeStep& step) {
  static_assert(sizeof(Start) == 7 * sizeof(double), "as per_node_data() has them");
  share_ = relaxation_time_ / step.length;
  starts_.resize(rods.positions.size());
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    EdgeDirection before = edge_direction(rods, rods.first(rod));
    starts_[rods.first(rod)].length = before.length;
    for (std::uint32_t i = rods.first(rod) + 1; i + 1 < rods.end(rod); ++i) {
      const EdgeDirection after = edge_direction(rods, i);
      const EdgeDirection middle = direction_of(before.tangent + after.tangent);
      starts_[i].length = after.length;
      starts_[i].turn = after.tangent - before.tangent;
      starts_[i].middle = middle.length > min_middle ? middle.tangent : Vector3d(Vector3d::Zero());
      before = after;
    }
  }
}

LaneEffect::Kernels Damping::kernels() const {
  return {&HWY_DYNAMIC_DISPATCH(energy), &HWY_DYNAMIC_DISPATCH(add_derivatives), &share_};
}

void Damping::add_forces(const RodPack& rods, const NodeValues& values, RodForces& forces) const {
  for_each_edge(rods, [&](const PackLane& rod, std::uint32_t edge, std::uint32_t index) {
    const EdgeDirection after = rod.direction(edge);
    const SimdBatch* const start = &values[std::size_t{7} * edge];
    const auto vector = [&](std::size_t first) {
      return Vector3d(start[first][rod.lane()], start[first + 1][rod.lane()],
                      start[first + 2][rod.lane()]);
    };
    forces.tensions[index] += share_ * rod.stretching_stiffness() *
                              (after.length - start[6][rod.lane()]) / rod.rest_length(edge);
    const Vector3d old_middle = vector(3);
    if (edge > 0 && !old_middle.isZero(0.0)) {
      const EdgeDirection before = rod.direction(edge - 1);
      const Vector3d middle = direction_of(before.tangent + after.tangent).tangent;
      const Vector3d change =
          after.tangent - before.tangent - transport(vector(0), old_middle, middle);
      const double length = 0.5 * (rod.rest_length(edge - 1) + rod.rest_length(edge));
      forces.bending_moments[index] +=
          share_ * rod.bending_stiffness() / length * middle.cross(change);
    }
  });
}

}  // namespace fiber
#endif
