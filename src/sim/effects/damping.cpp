// Compiled once per instruction set; Highway chooses among them at run time.
#include "fiber_proximity/sim/effects.hpp"
#include "fiber_proximity/sim/forces.hpp"
#include "src/sim/effects/section_damping.hpp"
#include "src/sim/require.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/effects/damping.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <limits>

#include "src/sim/effects/strains-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

// Numbers that Damping keeps of each node without twist.
constexpr std::size_t sizes_per_node = 2;

void energy(const RodPack& rods, const NodeValues& earlier, const double* share,
            SimdBatch& energy) {
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    Real stretch = real(0.0);
    Real bend = real(0.0);
    for (std::size_t i = 0; i + 1 < rods.node_count; ++i) {
      const SimdBatch* const values = &earlier[sizes_per_node * i];
      const Real longer = lengthening(rods, values[0], i, lane);
      stretch = stretch + longer * longer * load(rods.inverse_stretching_lengths[i], lane);
      if (i > 0) {
        const Real larger = sized_turn(edges_beside(rods, i, lane), load(values[1], lane)).excess;
        bend = bend + larger * larger * load(rods.inverse_bending_lengths[i], lane);
      }
    }
    const Real sum =
        load(rods.stretching_stiffness, lane) * stretch + load(rods.bending_stiffness, lane) * bend;
    store(real(0.5 * *share) * sum, energy, lane);
  }
}

template <std::size_t U>
void add_derivatives_of(const RodPack& rods, const NodeValues& earlier, const double* constants,
                        PackSystem& system) {
  const double share = constants[0];
  const Real min_sideways = real(constants[1]);
  const Real smallest = real(std::numeric_limits<double>::min());
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    const Real stretching = real(share) * load(rods.stretching_stiffness, lane);
    const Real bending = real(share) * load(rods.bending_stiffness, lane);
    for (std::size_t i = 0; i + 1 < rods.node_count; ++i) {
      const SimdBatch* const values = &earlier[sizes_per_node * i];
      add_lengthening<U>(rods, values[0], stretching, i, lane, system);
      if (i > 0) {
        const TwoEdges edges = edges_beside(rods, i, lane);
        const SizedTurn turn = sized_turn(edges, load(values[1], lane));
        // Where the rod has become straight, no side is better than another: there is no force.
        const Vector direction = real(1.0) / hn::Max(turn.size, smallest) * turn.turn;
        const Real stiffness = bending * load(rods.inverse_bending_lengths[i], lane);
        add_sized_turn<U>(edges, turn, direction, stiffness, min_sideways, i, lane, system);
      }
    }
  }
}

void add_derivatives(const RodPack& rods, const NodeValues& earlier, const double* constants,
                     PackSystem& system) {
  with_unknowns(system, [&](auto u) { add_derivatives_of<u>(rods, earlier, constants, system); });
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

namespace {

using HWY_NAMESPACE::sizes_per_node;

/// Adds the lengths of a state's edges, times a weight.
void add_lengths(const Rods& rods, const RodState& state, double weight, std::size_t per_node,
                 std::vector<double>& strains) {
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
      strains[per_node * i] += weight * edge_direction(state, i).length;
    }
  }
}

/// Adds the sizes of a state's turns, times a weight.
void add_turn_sizes(const Rods& rods, const RodState& state, double weight,
                    std::vector<double>& strains) {
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    for (std::uint32_t i = rods.first(rod) + 1; i + 1 < rods.end(rod); ++i) {
      const Vector3d turn = edge_direction(state, i).tangent - edge_direction(state, i - 1).tangent;
      strains[sizes_per_node * i + 1] += weight * turn.norm();
    }
  }
}

}  // namespace

Damping::Damping(double relaxation_time, bool is_beside_bend)
    : relaxation_time_(relaxation_time), is_beside_bend_(is_beside_bend) {
  require_not_negative("damping: the relaxation time", relaxation_time, " s");
}

void Damping::begin_step(Rods& rods, const TimeStep& step) {
  const double share = relaxation_time_ / step.length;
  constants_ = {share, is_beside_bend_ && share > 0.0 ? -1.0 / share : 0.0};
  const bool has_twist = !rods.angles.empty();
  per_node_ = has_twist ? section_strains_per_node : sizes_per_node;
  earlier_.assign(per_node_ * rods.positions.size(), 0.0);
  step.for_each_earlier(rods, [&](const RodState& state, double weight) {
    add_lengths(rods, state, weight, per_node_, earlier_);
    if (has_twist) {
      add_section_strains(rods, state, weight, earlier_);
    } else {
      add_turn_sizes(rods, state, weight, earlier_);
    }
  });
  if (!has_twist) {
    // No size is below 0: a turn that two states would bring to the other side comes back to this.
    for (double& size : earlier_) {
      size = std::max(size, 0.0);
    }
  }
}

LaneEffect::Kernels Damping::kernels() const {
  if (per_node_ == section_strains_per_node) {
    return {&section_damping_energy, &add_section_damping, constants_.data()};
  }
  return {&HWY_DYNAMIC_DISPATCH(energy), &HWY_DYNAMIC_DISPATCH(add_derivatives), constants_.data()};
}

void Damping::add_forces(const RodPack& rods, const NodeValues& values, RodForces& forces) const {
  const std::vector<SimdBatch> moments = per_node_ == section_strains_per_node
                                             ? section_damping_moments(rods, values, constants_[0])
                                             : std::vector<SimdBatch>();
  for_each_edge(rods, [&](const PackLane& rod, std::uint32_t edge, std::uint32_t index) {
    const std::size_t lane = rod.lane();
    const EdgeDirection after = rod.direction(edge);
    const SimdBatch* const earlier = &values[std::size_t{per_node_} * edge];
    forces.tensions[index] += constants_[0] * rod.stretching_stiffness(edge) *
                              (after.length - earlier[0][lane]) / rod.rest_length(edge);
    if (edge == 0) {
      return;
    }
    if (!moments.empty()) {
      const SimdBatch* const moment = &moments[std::size_t{4} * edge];
      forces.bending_moments[index] += Vector3d(moment[0][lane], moment[1][lane], moment[2][lane]);
      forces.twisting_moments[index] += moment[3][lane];
      return;
    }
    const Vector3d before = rod.direction(edge - 1).tangent;
    const double size = (after.tangent - before).norm();
    const double length = 0.5 * (rod.rest_length(edge - 1) + rod.rest_length(edge));
    const double share = size > 0.0 ? constants_[0] * (1.0 - earlier[1][lane] / size) : 0.0;
    forces.bending_moments[index] +=
        share * rod.bending_stiffness(edge) / length * before.cross(after.tangent);
  });
}

}  // namespace fiber
#endif
