#pragma once

#include <cassert>
#include <cstdint>
#include <vector>

namespace fiber {

/// Consecutive leaves of a tree, as positions in its order of segments.
struct LeafRun {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;

  std::uint32_t size() const { return end - begin; }
};

/// The shape of a binary tree over segments, without volumes: flat, in level order, root first.
///
/// A node is an index. Siblings stand side by side and parents before their children, so an update
/// from the leaves to the root is one loop from the last node to the first, and one 32-bit number
/// per node holds either its first child or, for a leaf, its segment.
class BinaryTree {
 public:
  /// Builds the tree over the given segments, level by level, without recursion.
  /// @param order segments, as the indices of their first points; `split` may reorder a run of it
  /// @param split (node, its LeafRun of two leaves at least) → position where the right child
  /// begins
  /// @param runs if not null, receives the leaves below each node
  template <class Split>
  void build(const std::vector<std::uint32_t>& order, const Split& split,
             std::vector<LeafRun>* runs = nullptr);

  std::uint32_t node_count() const { return static_cast<std::uint32_t>(nodes_.size()); }
  std::uint32_t level_count() const { return static_cast<std::uint32_t>(levels_.size()); }
  bool empty() const { return nodes_.empty(); }
  std::size_t memory_bytes() const {
    return (nodes_.capacity() + levels_.capacity()) * sizeof(std::uint32_t);
  }

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

/// The split of a balanced tree (paper, Sect. 3.1): in the middle of the run, so that the depths of
/// leaves differ by at most one.
struct SplitInMiddle {
  std::uint32_t operator()(std::uint32_t /*node*/, const LeafRun& run) const {
    return run.begin + (run.size() + 1) / 2;
  }
};

template <class Split>
void BinaryTree::build(const std::vector<std::uint32_t>& order, const Split& split,
                       std::vector<LeafRun>* runs) {
  nodes_.clear();
  levels_.clear();
  if (runs != nullptr) {
    runs->clear();
  }
  if (order.empty()) {
    return;
  }
  nodes_.reserve(2 * order.size() - 1);
  std::vector<LeafRun> level{{0, static_cast<std::uint32_t>(order.size())}};
  std::vector<LeafRun> next;
  while (!level.empty()) {
    const std::uint32_t next_begin = node_count() + static_cast<std::uint32_t>(level.size());
    levels_.push_back(node_count());
    next.clear();
    if (runs != nullptr) {
      runs->insert(runs->end(), level.begin(), level.end());
    }
    for (const LeafRun& run : level) {
      if (run.size() == 1) {
        nodes_.push_back(leaf_flag | order[run.begin]);
        continue;
      }
      const std::uint32_t middle = split(node_count(), run);
      nodes_.push_back(next_begin + static_cast<std::uint32_t>(next.size()));
      assert(run.begin < middle && middle < run.end);
      next.push_back({run.begin, middle});
      next.push_back({middle, run.end});
    }
    level.swap(next);
  }
}

}  // namespace fiber
