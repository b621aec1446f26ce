#pragma once

#include <Eigen/Core>
#include <cassert>
#include <cstdint>
#include <vector>

#include "fiber_proximity/sim/band_matrix.hpp"
#include "fiber_proximity/sim/rod_lanes.hpp"

namespace fiber {

/// Gradient and Hessian of the energy of one rod, which effects add up.
/// Nodes are counted from the rod's first one. Unknown are the positions of the nodes and, with
/// twist, the angle of the edge after each: (x, y, z[, angle]) node by node.
class RodSystem {
 public:
  /// @param unknowns of each node: 3, or 4 with twist
  RodSystem(std::uint32_t node_count, std::uint32_t unknowns);

  /// That of one of some rods side by side, to add to; only hold() and the functions that
  /// add are for it.
  /// @param system must outlive this, and not change its size
  RodSystem(LaneSystem& system, std::size_t lane);

  RodSystem(RodSystem&&) = default;
  RodSystem(const RodSystem&) = delete;
  RodSystem& operator=(RodSystem&&) = delete;
  RodSystem& operator=(const RodSystem&) = delete;
  ~RodSystem() = default;

  void set_zero();

  void add_gradient(std::uint32_t node, const Eigen::Vector3d& gradient) {
    double* const first = gradients_ + std::size_t{node} * unknowns_ * stride_;
    for (int i = 0; i < 3; ++i) {
      first[i * stride_] += gradient[i];
    }
  }
  void add_angle_gradient(std::uint32_t edge, double gradient) {
    assert(unknowns_ == 4);
    gradient_[edge * unknowns_ + 3] += gradient;
  }

  /// Adds the symmetric block of one node.
  void add_hessian(std::uint32_t node, const Eigen::Matrix3d& block) {
    const std::size_t first = std::size_t{node} * unknowns_;
    for (int c = 0; c < 3; ++c) {
      for (int r = c; r < 3; ++r) {
        add_hessian_entry(first + r, first + c, block(r, c));
      }
    }
  }

  /// Adds the block of two nodes, row > column >= row - 2, and its transpose.
  void add_hessian(std::uint32_t row, std::uint32_t column, const Eigen::Matrix3d& block) {
    assert(row > column);
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) {
        add_hessian_entry(std::size_t{row} * unknowns_ + r, std::size_t{column} * unknowns_ + c,
                          block(r, c));
      }
    }
  }

  /// Adds the derivatives of an energy of one edge: the gradient by its second node, which is minus
  /// that by its first, and so the Hessian's block.
  void add_edge(std::uint32_t edge, const Eigen::Vector3d& gradient, const Eigen::Matrix3d& block) {
    add_gradient(edge, -gradient);
    add_gradient(edge + 1, gradient);
    add_hessian(edge, block);
    add_hessian(edge + 1, block);
    add_hessian(edge + 1, edge, -block);
  }

  /// One entry, of unknowns counted through: row >= column.
  void add_hessian_entry(std::size_t row, std::size_t column, double value) {
    entries_[(column * (hessian_.half_bandwidth() + 1) + (row - column)) * stride_] += value;
  }

  /// The node does not move: its gradient is zero, and so is what solve() makes of that.
  void hold(std::uint32_t node);

  /// Replaces the Hessian by its factors.
  void factorise();

  /// Solves the equation of the factorised Hessian.
  /// @param values as many as the gradient has: the right-hand side, then the solution
  void solve(double* values) const { hessian_.solve(values); }

  const std::vector<double>& gradient() const { return gradient_; }
  std::uint32_t unknowns() const { return unknowns_; }

  /// Before factorise(), which replaces it by its factors.
  const BandMatrix& hessian() const { return hessian_; }

 private:
  std::uint32_t unknowns_;
  BandMatrix hessian_;
  std::vector<double> gradient_;
  double* entries_;     // of the Hessian, in the order of BandMatrix
  double* gradients_;   // in the order of the unknowns
  std::size_t stride_;  // from one entry to the next
};

}  // namespace fiber
