#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "fiber_proximity/hierarchy/hierarchy.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/pair_collector.hpp"

namespace fiber {

/// Simultaneous descent of two hierarchies (paper, Sect. 3.2): offers the collector every pair of
/// leaves whose volumes come within its bound. Given the same hierarchy twice it finds
/// self-collisions, comparing the left and the right subtree of every node.
///
/// Pairs wait on an explicit stack, so the depth of a tree is no limit. With NearFirst they carry
/// the distance of their volumes: the nearest of a node's children is visited first, and what the
/// shrinking bound has overtaken is dropped when its turn comes.
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
        counts_(counts) {
    stack_.reserve(256);
  }

  void run() {
    if (a_.tree().empty() || b_.tree().empty()) {
      return;
    }
    push_pair(0, 0);
    while (!stack_.empty() && !collector_.done()) {
      const Pair pair = stack_.back();
      stack_.pop_back();
      if (NearFirst && pair.distance > collector_.bound()) {
        continue;
      }
      visit(pair.a, pair.b);
    }
  }

 private:
  struct Pair {
    std::uint32_t a;
    std::uint32_t b;
    float distance;  // [m] lower bound, with NearFirst
  };

  void visit(std::uint32_t a, std::uint32_t b) {
    const bool a_is_leaf = a_.tree().is_leaf(a);
    const bool b_is_leaf = b_.tree().is_leaf(b);
    const std::size_t first_new = stack_.size();
    if (self_ && a == b) {
      if (a_is_leaf) {
        return;
      }
      const std::uint32_t child = a_.tree().first_child(a);
      stack_.push_back({child + 1, child + 1, 0.0F});
      stack_.push_back({child, child, 0.0F});
      push_pair(child, child + 1);
      return;
    }
    if (a_is_leaf && b_is_leaf) {
      collector_.offer(a_.tree().leaf_point(a), b_.tree().leaf_point(b));
      return;
    }
    // Nodes of one level are about the same size: both are split.
    const std::uint32_t a_begin = a_is_leaf ? a : a_.tree().first_child(a);
    const std::uint32_t b_begin = b_is_leaf ? b : b_.tree().first_child(b);
    for (std::uint32_t child_a = a_begin; child_a <= a_begin + (a_is_leaf ? 0 : 1); ++child_a) {
      for (std::uint32_t child_b = b_begin; child_b <= b_begin + (b_is_leaf ? 0 : 1); ++child_b) {
        push_pair(child_a, child_b);
      }
    }
    if (NearFirst) {
      std::sort(stack_.begin() + static_cast<std::ptrdiff_t>(first_new), stack_.end(),
                [](const Pair& x, const Pair& y) { return x.distance > y.distance; });
    }
  }

  void push_pair(std::uint32_t a, std::uint32_t b) {
    if (self_ && a == b) {
      stack_.push_back({a, b, 0.0F});
      return;
    }
    if (!leaf_pretest_ && a_.tree().is_leaf(a) && b_.tree().is_leaf(b)) {
      stack_.push_back({a, b, 0.0F});
      return;
    }
    ++counts_.node_tests;
    const Volume& volume_a = a_.volume(a);
    const Volume& volume_b = b_.volume(b);
    if (!overlaps(volume_a, volume_b, collector_.bound())) {
      return;
    }
    ++counts_.node_overlaps;
    stack_.push_back({a, b, NearFirst ? distance_lower_bound(volume_a, volume_b) : 0.0F});
  }

  const Hierarchy<Volume>& a_;
  const Hierarchy<Volume>& b_;
  const bool self_;
  const bool leaf_pretest_;
  PairCollector& collector_;
  QueryCounts& counts_;
  std::vector<Pair> stack_;
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
