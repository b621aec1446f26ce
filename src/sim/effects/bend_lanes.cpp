// Compiled once per instruction set; Highway chooses among them at run time.
#include <Eigen/Geometry>

#include "fiber_proximity/sim/effects/bend.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/effects/bend_lanes.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/sim/edge_pair-inl.hpp"

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

template <std::size_t U>
void add_derivatives_of(const RodLanes& rods, LaneSystem& system) {
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
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

void add_derivatives(const RodLanes& rods, LaneSystem& system) {
  system.unknowns == 3 ? add_derivatives_of<3>(rods, system) : add_derivatives_of<4>(rods, system);
}

/// How a node is bent against its natural curvature.
struct CurvedTurn {
  Vector turn;
  Real size;
  Real excess;
};

/// @param natural what Bend keeps of the nodes
HWY_INLINE CurvedTurn curved_turn(const TwoEdges& edges, const Lanes& natural, std::size_t lane) {
  const Vector turn = edges.after - edges.before;
  const Real size = square_root(dot(turn, turn));
  return {turn, size, size - load(natural, lane)};
}

void curved_energy(const RodLanes& rods, const std::vector<Lanes>& natural, Lanes& energy) {
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
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
  Lanes across[3];
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
void add_curved_derivatives_of(const RodLanes& rods, const std::vector<Lanes>& natural,
                               LaneSystem& system) {
  const Real zero = real(0.0);
  const Real one = real(1.0);
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
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

void add_curved_derivatives(const RodLanes& rods, const std::vector<Lanes>& natural,
                            LaneSystem& system) {
  system.unknowns == 3 ? add_curved_derivatives_of<3>(rods, natural, system)
                       : add_curved_derivatives_of<4>(rods, natural, system);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(energy);
HWY_EXPORT(add_derivatives);
HWY_EXPORT(curved_energy);
HWY_EXPORT(add_curved_derivatives);

void Bend::energy_in_lanes(const RodLanes& rods, const std::vector<Lanes>& values,
                           Lanes& energy) const {
  if (natural_turns_.empty()) {
    HWY_DYNAMIC_DISPATCH(energy)(rods, energy);
  } else {
    HWY_DYNAMIC_DISPATCH(curved_energy)(rods, values, energy);
  }
}

void Bend::add_derivatives_in_lanes(const RodLanes& rods, const std::vector<Lanes>& values,
                                    LaneSystem& system) const {
  if (natural_turns_.empty()) {
    HWY_DYNAMIC_DISPATCH(add_derivatives)(rods, system);
  } else {
    HWY_DYNAMIC_DISPATCH(add_curved_derivatives)(rods, values, system);
  }
}

}  // namespace fiber
#endif
