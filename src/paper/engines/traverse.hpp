#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/pair_collector.hpp"
#include "src/paper/hierarchy/hierarchy.hpp"

namespace fiber {

/// Simultaneous descent of two hierarchies (paper, Sect. 3.2): offers the collector every pair of
/// leaves whose volumes come within its bound. Given the same hierarchy twice it finds
/// self-collisions, comparing the left and the right subtree of every node.
///
/// Pairs wait on an explicit stack, so the depth of a tree is no limit. Every new pair is written
/// there and stays only if its volumes come within the bound, without a branch: whether they do is
/// beyond what a processor can predict. With NearFirst pairs carry the distance of their volumes:
/// the nearest of a node's children is visited first, and what the shrinking bound has overtaken is
/// dropped when its turn comes.
template <class Volume, bool NearFirst>
class Traversal {
 public:
  Traversal(const Hierarchy<Volume>& a, const Hierarchy<Volume>& b, const QueryOptions& options,
            PairCollector& collector, QueryCounts& counts)
      : a_(a),
        b_(b),
        self_(&a == &b),
        leaf_pretest_(options.leaf_pretest),
        collector_(collector),
        counts_(counts) {}

  void run() {
    if (a_.tree().empty() || b_.tree().empty()) {
      return;
    }
    if (self_) {
      push(0, 0);
    } else {
      push_if_near(0, 0);
    }
    while (size_ > 0 && !collector_.done()) {
      const Pair pair = stack_[--size_];
      if (NearFirst && pair.distance > collector_.bound()) {
        continue;
      }
      if (stack_.size() < size_ + most_pushed) {
        stack_.resize(2 * stack_.size());
      }
      if (self_ && pair.a == pair.b) {
        visit_same(pair.a);
      } else {
        visit(pair.a, pair.b);
      }
    }
  }

 private:
  struct Pair {
    std::uint32_t a;
    std::uint32_t b;
    float distance;  // [m] lower bound, with NearFirst
  };

  static constexpr std::size_t most_pushed = 4;  // by one visit

  void visit(std::uint32_t a, std::uint32_t b) {
    const BinaryTree& tree_a = a_.tree();
    const BinaryTree& tree_b = b_.tree();
    const std::size_t first_new = size_;
    if (!tree_a.is_leaf(a) && !tree_b.is_leaf(b)) {
      // Nodes of one level are about the same size: both are split.
      const std::uint32_t child_a = tree_a.first_child(a);
      const std::uint32_t child_b = tree_b.first_child(b);
      push_if_near(child_a, child_b);
      push_if_near(child_a, child_b + 1);
      push_if_near(child_a + 1, child_b);
      push_if_near(child_a + 1, child_b + 1);
    } else if (!tree_a.is_leaf(a)) {
      push_if_near(tree_a.first_child(a), b);
      push_if_near(tree_a.first_child(a) + 1, b);
    } else if (!tree_b.is_leaf(b)) {
      push_if_near(a, tree_b.first_child(b));
      push_if_near(a, tree_b.first_child(b) + 1);
    } else {
      collector_.offer(tree_a.leaf_point(a), tree_b.leaf_point(b));
    }
    if (NearFirst && size_ > first_new + 1) {
      std::sort(stack_.data() + first_new, stack_.data() + size_,
                [](const Pair& x, const Pair& y) { return x.distance > y.distance; });
    }
  }

  /// A node with itself: each of its children with itself, and the two with each other.
  void visit_same(std::uint32_t node) {
    if (a_.tree().is_leaf(node)) {
      return;
    }
    const std::uint32_t child = a_.tree().first_child(node);
    push(child + 1, child + 1);
    push(child, child);
    push_if_near(child, child + 1);
  }

  void push(std::uint32_t a, std::uint32_t b) { stack_[size_++] = {a, b, 0.0F}; }

  // Ten places call this, too many for the compiler to inline it unasked; out of line it costs a
  // third more.
  [[gnu::always_inline]] inline void push_if_near(std::uint32_t a, std::uint32_t b) {
    if (!leaf_pretest_ && a_.tree().is_leaf(a) && b_.tree().is_leaf(b)) {
      push(a, b);
      return;
    }
    const Volume& volume_a = a_.volume(a);
    const Volume& volume_b = b_.volume(b);
    const bool near = overlaps(volume_a, volume_b, collector_.bound());
    stack_[size_] = {a, b, NearFirst && near ? distance_lower_bound(volume_a, volume_b) : 0.0F};
    size_ += near ? 1 : 0;
    counts_.node_tests += 1;
    counts_.node_overlaps += near ? 1 : 0;
  }

  const Hierarchy<Volume>& a_;
  const Hierarchy<Volume>& b_;
  const bool self_;
  const bool leaf_pretest_;
  PairCollector& collector_;
  QueryCounts& counts_;
  std::vector<Pair> stack_ = std::vector<Pair>(256);
  std::size_t size_ = 0;  // of what waits on the stack
};

/// Offers the collector every pair of leaves it may be interested in; see Traversal.
template <class Volume>
void traverse(const Hierarchy<Volume>& a, const Hierarchy<Volume>& b, const QueryOptions& options,
              PairCollector& collector, QueryCounts& counts) {
  if (collector.wants_near_first()) {
    Traversal<Volume, true>(a, b, options, collector, counts).run();
  } else {
    Traversal<Volume, false>(a, b, options, collector, counts).run();
  }
}

}  // namespace fiber
