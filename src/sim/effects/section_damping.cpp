// Compiled once per instruction set; Highway chooses among them at run time.
#include "src/sim/effects/section_damping.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/effects/section_damping.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <limits>

#include "src/sim/effects/strains-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

HWY_INLINE Section section_at(const RodPack& rods, std::size_t edge, std::size_t lane) {
  return section_of(tangent_at(rods, edge, lane), load_vector(&rods.directors[3 * edge], lane),
                    angle_at(rods, edge, lane));
}

/// The changes of the strains at a node since the earlier states.
struct SectionChange {
  SectionBend bend;  // its values are changes
  Real twist;
};

HWY_INLINE SectionChange change_at(const RodPack& rods, const SimdBatch* earlier,
                                   const Section& before, const Section& after, std::size_t node,
                                   std::size_t lane) {
  SectionChange change;
  change.bend = section_bend(before, after);
  for (std::size_t j = 0; j < 2; ++j) {
    change.bend.values[j] = change.bend.values[j] - load(earlier[1 + j], lane);
  }
  const Real directors =
      nearest_turn(load(rods.director_twists[node], lane), load(earlier[4], lane));
  change.twist = angle_at(rods, node, lane) - angle_at(rods, node - 1, lane) + directors -
                 load(earlier[3], lane);
  return change;
}

/// Calls function(node, change) for the inner nodes of the rods from a lane on.
template <class Function>
HWY_INLINE void for_each_change(const RodPack& rods, const NodeValues& earlier, std::size_t lane,
                                const Function& function) {
  Section before = section_at(rods, 0, lane);
  for (std::size_t i = 1; i + 1 < rods.node_count; ++i) {
    const Section after = section_at(rods, i, lane);
    function(i, change_at(rods, &earlier[section_strains_per_node * i], before, after, i, lane));
    before = after;
  }
}

void energy(const RodPack& rods, const NodeValues& earlier, const double* share,
            SimdBatch& energy) {
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    Real stretch = real(0.0);
    for (std::size_t i = 0; i + 1 < rods.node_count; ++i) {
      const Real longer = lengthening(rods, earlier[section_strains_per_node * i], i, lane);
      stretch = stretch + longer * longer * load(rods.inverse_stretching_lengths[i], lane);
    }
    Real bend = real(0.0);
    Real twist = real(0.0);
    for_each_change(rods, earlier, lane, [&](std::size_t node, const SectionChange& change) {
      const auto& [first, second] = change.bend.values;
      bend =
          bend + (first * first + second * second) * load(rods.inverse_bending_lengths[node], lane);
      twist = twist + change.twist * change.twist * load(rods.inverse_twisting_lengths[node], lane);
    });
    const Real sum = load(rods.stretching_stiffness, lane) * stretch +
                     load(rods.bending_stiffness, lane) * bend +
                     load(rods.twisting_stiffness, lane) * twist;
    store(real(0.5 * *share) * sum, energy, lane);
  }
}

void add_derivatives(const RodPack& rods, const NodeValues& earlier, const double* share,
                     PackSystem& system) {
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    const Real stretching = real(*share) * load(rods.stretching_stiffness, lane);
    const Real bending = real(*share) * load(rods.bending_stiffness, lane);
    const Real twisting = real(*share) * load(rods.twisting_stiffness, lane);
    for (std::size_t i = 0; i + 1 < rods.node_count; ++i) {
      add_lengthening<section_unknowns>(rods, earlier[section_strains_per_node * i], stretching, i,
                                        lane, system);
    }
    for_each_change(rods, earlier, lane, [&](std::size_t node, const SectionChange& change) {
      const Real stiffness = bending * load(rods.inverse_bending_lengths[node], lane);
      const Real twisting_stiffness = twisting * load(rods.inverse_twisting_lengths[node], lane);
      for (std::size_t j = 0; j < 2; ++j) {
        add_square(by_rotation(rods, change.bend.by_rotation[j], node, lane),
                   stiffness * change.bend.values[j], stiffness, node, lane, system);
      }
      add_square(twist_derivative(rods, node, lane), twisting_stiffness * change.twist,
                 twisting_stiffness, node, lane, system);
    });
  }
}

/// The moments of the pack's rods, node by node: three of bending and the twisting one.
void find_moments(const RodPack& rods, const NodeValues& earlier, double share,
                  std::vector<SimdBatch>& moments) {
  moments.assign(std::size_t{4} * rods.node_count, SimdBatch{});
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    for_each_change(rods, earlier, lane, [&](std::size_t node, const SectionChange& change) {
      const Real bending = real(share) * load(rods.inverse_bending_lengths[node], lane);
      const Real twisting = real(share) * load(rods.inverse_twisting_lengths[node], lane);
      const Real stiffness = bending * load(rods.bending_stiffness, lane);
      const SectionBend& bend = change.bend;
      store(
          stiffness * (bend.values[0] * bend.by_rotation[0] + bend.values[1] * bend.by_rotation[1]),
          &moments[4 * node], lane);
      store(twisting * load(rods.twisting_stiffness, lane) * change.twist, moments[4 * node + 3],
            lane);
    });
  }
}

// The strains of states, with the nodes of a rod side by side.

/// Vectors of a rod, one after the other from the first one on; beyond the last one, that again.
HWY_INLINE Vector gathered(const std::vector<Eigen::Vector3d>& from, std::uint32_t first,
                           std::uint32_t last) {
  SimdBatch xyz[3];
  for (std::uint32_t l = 0; l < lanes_at_once(); ++l) {
    const Eigen::Vector3d& vector = from[std::min(first + l, last)];
    for (std::uint32_t k = 0; k < 3; ++k) {
      xyz[k][l] = vector[k];
    }
  }
  return load_vector(xyz, 0);
}

HWY_INLINE Real gathered(const std::vector<double>& from, std::uint32_t first, std::uint32_t last) {
  SimdBatch values;
  for (std::uint32_t l = 0; l < lanes_at_once(); ++l) {
    values[l] = from[std::min(first + l, last)];
  }
  return load(values, 0);
}

/// Edges of a rod in a state, and how they were when the step began.
struct EarlierEdges {
  Vector start_tangent;
  Vector start_director;
  Vector tangent;
  Vector director;
  Real angle;
};

/// @param last edge of the rod
HWY_INLINE EarlierEdges earlier_edges(const Rods& rods, const RodState& state, std::uint32_t first,
                                      std::uint32_t last) {
  const Vector edge =
      gathered(state.positions, first + 1, last + 1) - gathered(state.positions, first, last);
  const Real length = hn::Max(hn::Sqrt(dot(edge, edge)), real(std::numeric_limits<double>::min()));
  EarlierEdges edges;
  edges.start_tangent = gathered(rods.start_tangents, first, last);
  edges.start_director = gathered(rods.directors, first, last);
  edges.tangent = real(1.0) / length * edge;
  edges.director = transport(edges.start_director, edges.start_tangent, edges.tangent);
  edges.angle = gathered(state.angles, first, last);
  return edges;
}

/// Adds the strains of a state at all inner nodes, times a weight.
void add_strains(const Rods& rods, const RodState& state, double weight,
                 std::vector<double>& strains) {
  const auto width = static_cast<std::uint32_t>(lanes_at_once());
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    const std::uint32_t last = rods.end(rod) - 2;
    for (std::uint32_t i = rods.first(rod) + 1; i <= last; i += width) {
      const EarlierEdges before = earlier_edges(rods, state, i - 1, last - 1);
      const EarlierEdges after = earlier_edges(rods, state, i, last);
      const SectionBend bend =
          section_bend(section_of(before.tangent, before.director, before.angle),
                       section_of(after.tangent, after.director, after.angle));
      // States are less than half a turn from each other.
      const Real start_twist =
          signed_angle(transport(before.start_director, before.start_tangent, after.start_tangent),
                       after.start_director, after.start_tangent);
      const Real directors =
          nearest_turn(signed_angle(transport(before.director, before.tangent, after.tangent),
                                    after.director, after.tangent),
                       start_twist);
      SimdBatch values[4];
      store(bend.values[0], values[0], 0);
      store(bend.values[1], values[1], 0);
      store(after.angle - before.angle + directors, values[2], 0);
      store(directors, values[3], 0);
      for (std::uint32_t l = 0; l < std::min(width, last + 1 - i); ++l) {
        for (std::size_t k = 0; k < 4; ++k) {
          strains[section_strains_per_node * (i + l) + 1 + k] += weight * values[k][l];
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
HWY_EXPORT(find_moments);
HWY_EXPORT(add_strains);

void add_section_strains(const Rods& rods, const RodState& state, double weight,
                         std::vector<double>& strains) {
  HWY_DYNAMIC_DISPATCH(add_strains)(rods, state, weight, strains);
}

void section_damping_energy(const RodPack& rods, const NodeValues& earlier, const double* share,
                            SimdBatch& energy) {
  HWY_DYNAMIC_DISPATCH(energy)(rods, earlier, share, energy);
}

void add_section_damping(const RodPack& rods, const NodeValues& earlier, const double* share,
                         PackSystem& system) {
  HWY_DYNAMIC_DISPATCH(add_derivatives)(rods, earlier, share, system);
}

std::vector<SimdBatch> section_damping_moments(const RodPack& rods, const NodeValues& earlier,
                                               double share) {
  std::vector<SimdBatch> moments;
  HWY_DYNAMIC_DISPATCH(find_moments)(rods, earlier, share, moments);
  return moments;
}

}  // namespace fiber
#endif
