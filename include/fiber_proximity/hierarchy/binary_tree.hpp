#pragma once

#include <cassert>
#include <cstdint>
#include <vector>

namespace fiber {

/// The shape of a binary tree over segments, without volumes: flat, in level order, root first.
///
/// A node is an index. Siblings stand side by side and parents before their children, so an update
/// from the leaves to the root is one loop from the last node to the first, and one 32-bit number
/// per node holds either its first child or, for a leaf, its segment.
class BinaryTree {
 public:
  BinaryTree() = default;

  /// The balanced tree over the given segments in the given order (paper, Sect. 3.1): every node is
  /// split in the middle of its run, so the depths of leaves differ by at most one.
  static BinaryTree balanced(const std::vector<std::uint32_t>& order);

  std::uint32_t node_count() const { return static_cast<std::uint32_t>(nodes_.size()); }
  std::uint32_t level_count() const { return static_cast<std::uint32_t>(levels_.size()); }
  bool empty() const { return nodes_.empty(); }

  bool is_leaf(std::uint32_t node) const { return (nodes_[node] & leaf_flag) != 0; }

  /// The left child of an inner node; the right one follows it.
  std::uint32_t first_child(std::uint32_t node) const {
    assert(!is_leaf(node));
    return nodes_[node];
  }

  /// The segment of a leaf, as the index of its first point.
  std::uint32_t leaf_point(std::uint32_t node) const {
    assert(is_leaf(node));
    return nodes_[node] & ~leaf_flag;
  }

  /// First node of a level; levels count from the root, 0, and end where the next one begins.
  std::uint32_t level_begin(std::uint32_t level) const { return levels_[level]; }
  std::uint32_t level_end(std::uint32_t level) const {
    return level + 1 < level_count() ? levels_[level + 1] : node_count();
  }

 private:
  static constexpr std::uint32_t leaf_flag = 0x8000'0000U;

  std::vector<std::uint32_t> nodes_;
  std::vector<std::uint32_t> levels_;
};

}  // namespace fiber
