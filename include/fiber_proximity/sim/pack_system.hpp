#pragma once

#include <Eigen/Core>
#include <cassert>
#include <cstdint>

#include "fiber_proximity/sim/rod_pack.hpp"

namespace fiber {

/// How far off the diagonal a rod's Hessian has entries: what is unknown at a node meets what is
/// unknown at this node and the positions of the next two.
/// @param unknowns of each node: 3, or 4 with twist
constexpr std::size_t half_bandwidth(std::size_t unknowns) { return 2 * unknowns + 2; }

/// Gradients and Hessians of the rods of a pack, side by side.
/// Unknown are the positions of the nodes and, with twist, the angle of the edge after each:
/// (x, y, z[, angle]) node by node. Hessians are symmetric bands, column by column from the
/// diagonal down; after the last there are as many columns of zeros as a column has entries off the
/// diagonal.
struct PackSystem {
  /// What it holds then is not said.
  /// @param unknowns_per_node 3, or 4 with twist
  /// @param lanes_used        the first ones
  void resize(std::size_t node_count, std::size_t unknowns_per_node,
              std::size_t lanes_used = lane_count) {
    assert(unknowns_per_node == 3 || unknowns_per_node == 4);
    unknowns = unknowns_per_node;
    used = lanes_used;
    const std::size_t width = half_bandwidth(unknowns);
    gradient.resize(node_count * unknowns);
    hessian.resize((gradient.size() + width) * (width + 1));
  }

  void set_zero() {
    gradient.assign(gradient.size(), SimdBatch{});
    hessian.assign(hessian.size(), SimdBatch{});
  }

  std::size_t size() const { return gradient.size(); }

  std::size_t unknowns = 3;  ///< of each node
  std::size_t used = lane_count;
  std::vector<SimdBatch> gradient;
  std::vector<SimdBatch> hessian;
};

/// One rod's part of a PackSystem, for what is computed one rod after the other. Nodes are counted
/// from the rod's first one.
class RodSystem {
 public:
  /// @param system must outlive this, and not change its size
  RodSystem(PackSystem& system, std::size_t lane)
      : unknowns_(system.unknowns),
        height_(half_bandwidth(unknowns_) + 1),
        gradient_(&system.gradient[0][lane]),
        hessian_(&system.hessian[0][lane]) {}

  void add_gradient(std::uint32_t node, const Eigen::Vector3d& gradient) {
    for (std::size_t i = 0; i < 3; ++i) {
      gradient_[(node * unknowns_ + i) * lane_count] += gradient[static_cast<Eigen::Index>(i)];
    }
  }
  void add_angle_gradient(std::uint32_t edge, double gradient) {
    assert(unknowns_ == 4);
    gradient_[(edge * unknowns_ + 3) * lane_count] += gradient;
  }

  /// Adds the symmetric block of one node.
  void add_hessian(std::uint32_t node, const Eigen::Matrix3d& block) {
    const std::size_t first = node * unknowns_;
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
        add_hessian_entry(row * unknowns_ + r, column * unknowns_ + c, block(r, c));
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
    hessian_[place_of(row, column)] += value;
  }

  /// Of unknowns counted through, column <= row <= column + half_bandwidth().
  double gradient(std::size_t unknown) const { return gradient_[unknown * lane_count]; }
  double hessian(std::size_t row, std::size_t column) const {
    return hessian_[place_of(row, column)];
  }

  std::size_t unknowns() const { return unknowns_; }

 private:
  std::size_t place_of(std::size_t row, std::size_t column) const {
    return (column * height_ + (row - column)) * lane_count;
  }

  std::size_t unknowns_;
  std::size_t height_;  // of the band's columns
  double* gradient_;
  double* hessian_;
};

}  // namespace fiber
