#pragma once

#include "fiber_proximity/sim/rod_lanes.hpp"

namespace fiber {

/// How far off the diagonal a rod's Hessian has entries: what is unknown at a node meets what is
/// unknown at this node and the positions of the next two.
/// @param unknowns of each node: 3, or 4 with twist
constexpr std::size_t half_bandwidth(std::size_t unknowns) { return 2 * unknowns + 2; }

/// Gradients and Hessians of rods with the same number of nodes, side by side.
/// Unknown are the positions of the nodes and, with twist, the angle of the edge after each:
/// (x, y, z[, angle]) node by node. Hessians are symmetric bands, column by column from the
/// diagonal down; after the last there are as many columns of zeros as a column has entries off the
/// diagonal.
struct LaneSystem {
  LaneSystem() = default;

  /// All zero.
  /// @param unknowns_per_node 3, or 4 with twist
  LaneSystem(std::size_t node_count, std::size_t unknowns_per_node) {
    resize(node_count, unknowns_per_node);
  }

  /// What it holds then is not said.
  void resize(std::size_t node_count, std::size_t unknowns_per_node);

  void set_zero();

  std::size_t size() const { return gradient.size(); }

  std::size_t unknowns = 3;  ///< of each node
  std::vector<Lanes> gradient;
  std::vector<Lanes> hessian;
};

/// Replaces positive definite Hessians by factors L D Lᵀ, with the inverse of D on the diagonal.
/// Needs no pivoting. LAPACK's pbtrf does the same for one matrix, but works in calls per column,
/// each of which takes longer than a column of this width.
///
/// An unknown whose pivot is not positive, as rounding errors may leave it where stiffnesses differ
/// by more digits than numbers have, becomes as stiff as can be: its solution is about 0, and the
/// factors are those of a positive definite matrix.
void factorise_band(LaneSystem& system);

/// Solves equations with the factors.
/// @param values as many as the gradient has, right-hand sides and then the solutions; at least
///               half_bandwidth() zeros follow them
void solve_band(const LaneSystem& system, Lanes* values);

}  // namespace fiber
