// Compiled once per instruction set; Highway chooses among them at run time.
#include "fiber_proximity/sim/effects/bend.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "fiber_proximity/sim/edge_turn.hpp"
#include "fiber_proximity/sim/forces.hpp"
#include "src/sim/effects/natural_bend.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/effects/bend.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/sim/edge_turn-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

void energy(const RodPack& rods, SimdBatch& energy) {
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
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

template <std::size_t U>
void add_derivatives_of(const RodPack& rods, PackSystem& system) {
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    const Real total = load(rods.bending_stiffness, lane);
    for (std::size_t i = 1; i + 1 < rods.node_count; ++i) {
      const Real stiffness = total * load(rods.inverse_node_lengths[i], lane);
      const TwoEdges edges = edges_beside(rods, i, lane);
      const Vector gradient = stiffness * (edges.after - edges.before);
      add_gradient<U>(edges, negative(gradient), gradient, i, lane, system);
      add_hessian<U>(isotropic_blocks(edges, stiffness), i, lane, system);
    }
  }
}

void add_derivatives(const RodPack& rods, PackSystem& system) {
  with_unknowns(system, [&](auto u) { add_derivatives_of<u>(rods, system); });
}

/// How a node is bent against its natural curvature.
struct CurvedTurn {
  Vector turn;
  Real size;
  Real excess;
};

/// @param natural what Bend keeps of the nodes
HWY_INLINE CurvedTurn curved_turn(const TwoEdges& edges, const SimdBatch& natural,
                                  std::size_t lane) {
  const Vector turn = edges.after - edges.before;
  const Real size = square_root(dot(turn, turn));
  return {turn, size, size - load(natural, lane)};
}

void curved_energy(const RodPack& rods, const std::vector<SimdBatch>& natural, SimdBatch& energy) {
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    Real sum = real(0.0);
    for (std::size_t i = 1; i + 1 < rods.node_count; ++i) {
      const Real excess = curved_turn(edges_beside(rods, i, lane), natural[i], lane).excess;
      sum = sum + excess * excess * load(rods.inverse_node_lengths[i], lane);
    }
    store(real(0.5) * load(rods.bending_stiffness, lane) * sum, energy, lane);
  }
}

/// Of the turn; where there is none, one of those across the rod, found lane by lane.
HWY_INLINE Vector direction_of(const CurvedTurn& turn, const Vector& tangent) {
  const Real zero = real(0.0);
  const auto is_bent = hn::Gt(turn.size.value, zero.value);
  const Vector along = real(1.0) / turn.size * turn.turn;
  if (hn::AllTrue(LaneTag(), is_bent)) {
    return along;
  }
  SimdBatch across[3];
  store(tangent, across, 0);
  for (std::size_t l = 0; l < lanes_at_once(); ++l) {
    const Eigen::Vector3d of_lane =
        Eigen::Vector3d(across[0][l], across[1][l], across[2][l]).unitOrthogonal();
    for (std::size_t k = 0; k < 3; ++k) {
      across[k][l] = of_lane[static_cast<Eigen::Index>(k)];
    }
  }
  Vector direction;
  for (std::size_t k = 0; k < 3; ++k) {
    direction.of[k] = {hn::IfThenElse(is_bent, along.of[k].value, load(across[k], 0).value)};
  }
  return direction;
}

template <std::size_t U>
void add_curved_derivatives_of(const RodPack& rods, const std::vector<SimdBatch>& natural,
                               PackSystem& system) {
  const Real zero = real(0.0);
  const Real one = real(1.0);
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    const Real total = load(rods.bending_stiffness, lane);
    for (std::size_t i = 1; i + 1 < rods.node_count; ++i) {
      const Real stiffness = total * load(rods.inverse_node_lengths[i], lane);
      const TwoEdges edges = edges_beside(rods, i, lane);
      const CurvedTurn turn = curved_turn(edges, natural[i], lane);
      const Vector direction = direction_of(turn, edges.before);
      const Vector gradient = stiffness * turn.excess * direction;
      add_gradient<U>(edges, negative(gradient), gradient, i, lane, system);
      // A rod that is straighter than it wants to be gives way sideways: as in Stretch.
      const Real wanted = load(natural[i], lane);
      const Real share = larger(zero, turn.excess) / larger(turn.size, wanted);
      const auto is_straight = hn::Eq(wanted.value, zero.value);
      const Real sideways = {hn::IfThenElse(is_straight, one.value, share.value)};
      EdgeBlocks blocks = isotropic_blocks(edges, stiffness * sideways);
      add_along(edges, stiffness * (one - sideways), direction, blocks);
      add_hessian<U>(blocks, i, lane, system);
    }
  }
}

void add_curved_derivatives(const RodPack& rods, const std::vector<SimdBatch>& natural,
                            PackSystem& system) {
  with_unknowns(system, [&](auto u) { add_curved_derivatives_of<u>(rods, natural, system); });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

using Eigen::Vector3d;

HWY_EXPORT(energy);
HWY_EXPORT(add_derivatives);
HWY_EXPORT(curved_energy);
HWY_EXPORT(add_curved_derivatives);

namespace {

/// |k| of the natural curvature: that of an arc over the length that belongs to the node.
double natural_turn(const Rods& rods, std::uint32_t node) {
  if (rods.natural_curvatures.empty()) {
    return 0.0;
  }
  const double angle = rods.natural_curvatures[node] * rods.rest_length_at(node);
  return 2.0 * std::sin(0.5 * std::min(angle, M_PI));
}

/// Bending with a direction is rare: one rod after the other.
template <class Function>
void for_each_natural_bend(const RodPack& rods, const std::vector<SimdBatch>& values,
                           const Function& function) {
  for (std::size_t lane = 0; lane < rods.used; ++lane) {
    for (std::uint32_t node = 1; node + 1 < rods.node_count; ++node) {
      const Eigen::Vector2d curvature(values[std::size_t{2} * node][lane],
                                      values[std::size_t{2} * node + 1][lane]);
      const PackLane rod(rods, lane);
      function(rod, node, NaturalBend::at_node(rod, node, curvature));
    }
  }
}

}  // namespace

void Bend::begin_step(Rods& rods, const TimeStep& /*step*/) {
  natural_curvatures_ = rods.natural_curvature_vectors;
  natural_turns_.resize(natural_curvatures_.empty() ? rods.natural_curvatures.size() : 0);
  for (std::uint32_t rod = 0; rod < rods.count() && !natural_turns_.empty(); ++rod) {
    for (std::uint32_t i = rods.first(rod) + 1; i + 1 < rods.end(rod); ++i) {
      natural_turns_[i] = natural_turn(rods, i);
    }
  }
}

std::uint32_t Bend::values_per_node() const {
  return !natural_curvatures_.empty() ? 2 : natural_turns_.empty() ? 0 : 1;
}

const double* Bend::values_of(std::uint32_t node) const {
  return natural_curvatures_.empty() ? &natural_turns_[node] : natural_curvatures_[node].data();
}

void Bend::energy(const RodPack& rods, const std::vector<SimdBatch>& values,
                  SimdBatch& energy) const {
  if (!natural_curvatures_.empty()) {
    energy = SimdBatch{};
    for_each_natural_bend(
        rods, values, [&](const PackLane& rod, std::uint32_t /*node*/, const NaturalBend& bend) {
          energy[rod.lane()] += bend.energy();
        });
  } else if (natural_turns_.empty()) {
    HWY_DYNAMIC_DISPATCH(energy)(rods, energy);
  } else {
    HWY_DYNAMIC_DISPATCH(curved_energy)(rods, values, energy);
  }
}

void Bend::add_derivatives(const RodPack& rods, const std::vector<SimdBatch>& values,
                           PackSystem& system) const {
  if (!natural_curvatures_.empty()) {
    for_each_natural_bend(
        rods, values, [&](const PackLane& rod, std::uint32_t /*node*/, const NaturalBend& bend) {
          RodSystem of_rod(system, rod.lane());
          bend.add_derivatives(of_rod);
        });
  } else if (natural_turns_.empty()) {
    HWY_DYNAMIC_DISPATCH(add_derivatives)(rods, system);
  } else {
    HWY_DYNAMIC_DISPATCH(add_curved_derivatives)(rods, values, system);
  }
}

void Bend::add_forces(const RodPack& rods, const std::vector<SimdBatch>& values,
                      RodForces& forces) const {
  if (!natural_curvatures_.empty()) {
    for_each_natural_bend(
        rods, values, [&](const PackLane& rod, std::uint32_t node, const NaturalBend& bend) {
          forces.bending_moments[rods.first_nodes[rod.lane()] + node] += bend.moment();
        });
    return;
  }
  for_each_edge(rods, [&](const PackLane& rod, std::uint32_t edge, std::uint32_t index) {
    if (edge > 0) {
      const EdgeTurn pair(rod.direction(edge - 1), rod.direction(edge));
      const double natural = natural_turns_.empty() ? 0.0 : natural_turns_[index];
      const double turn = pair.turn().norm();
      const double length = 0.5 * (rod.rest_length(edge - 1) + rod.rest_length(edge));
      const Vector3d about = pair.before().tangent.cross(pair.after().tangent);
      const double share = turn > 0.0 ? 1.0 - natural / turn : 0.0;
      forces.bending_moments[index] += rod.bending_stiffness() / length * share * about;
    }
  });
}

}  // namespace fiber
#endif
