#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/query/for_engines/pair_collector.hpp"
#include "src/bounds/aabb.hpp"
#include "src/bounds/bounding_volume.hpp"
#include "src/paper/engines/leaf_pretest.hpp"
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
  Traversal(const Hierarchy<Volume>& a, const Hierarchy<Volume>& b, bool leaf_pretest,
            PairCollector& collector, QueryCounts& counts)
      : a_(a),
        b_(b),
        self_(&a == &b),
        leaf_pretest_(leaf_pretest),
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
      if (stack_.size() < size_ + max_pushed) {
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

  static constexpr std::size_t max_pushed = 4;  // by one visit

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
void traverse(const Hierarchy<Volume>& a, const Hierarchy<Volume>& b, bool leaf_pretest,
              PairCollector& collector, QueryCounts& counts) {
  if (collector.wants_near_first()) {
    Traversal<Volume, true>(a, b, leaf_pretest, collector, counts).run();
  } else {
    Traversal<Volume, false>(a, b, leaf_pretest, collector, counts).run();
  }
}

/// One of the paper's hierarchies as an engine.
/// @tparam Kind a hierarchy with build(fibers, origin) and update(fibers, origin)
template <class Kind>
class HierarchyEngine final : public ProximityEngine, public LeafPretest {
 public:
  using Volume = typename Kind::Volume;

  explicit HierarchyEngine(Kind hierarchy) : hierarchy_(std::move(hierarchy)) {}

  EngineFacts facts() const override {
    EngineFacts facts;
    facts.memory_bytes = hierarchy_.memory_bytes();
    facts.level_count = level_count();
    facts.recomputed_count = hierarchy_.recomputed_count();
    return facts;
  }

  void level_boxes(std::uint32_t level, std::vector<NodeBox>& boxes) const override {
    boxes.clear();
    const BinaryTree& tree = hierarchy_.tree();
    const std::uint32_t shown = shown_level(level);
    // Leaves further up stand in for what is not there below them.
    for (std::uint32_t node = 0; node < level_end(shown); ++node) {
      if (node >= tree.level_begin(shown) || tree.is_leaf(node)) {
        const Aabb box = bounding_box(hierarchy_.volume(node), hierarchy_.parameters());
        boxes.push_back({hierarchy_.origin() + to_vector(box.lower),
                         hierarchy_.origin() + to_vector(box.upper)});
      }
    }
  }

  double mean_level_volume(std::uint32_t level) const override {
    const std::uint32_t shown = shown_level(level);
    const std::uint32_t begin = level_count() == 0 ? 0 : hierarchy_.tree().level_begin(shown);
    const std::uint32_t end = level_end(shown);
    double sum = 0.0;
    for (std::uint32_t node = begin; node < end; ++node) {
      sum += volume(hierarchy_.volume(node), hierarchy_.parameters());
    }
    return begin == end ? 0.0 : sum / (end - begin);
  }

 protected:
  void do_update(const FiberAssembly& fibers, bool same_topology) override {
    const Eigen::Vector3d origin = hierarchy_origin(fibers);
    if (same_topology) {
      hierarchy_.update(fibers, origin);
    } else {
      hierarchy_.build(fibers, origin);
    }
  }

  void do_query(const FiberAssembly& fibers, const QueryOptions& options,
                QueryResult& result) const override {
    PairCollector collector(fibers, options, result);
    traverse<Volume>(hierarchy_, hierarchy_, has_leaf_pretest(), collector, result.counts);
    collector.finish();
  }

  void do_query_shape(const FiberAssembly& shape, const FiberAssembly& fibers,
                      const QueryOptions& options, QueryResult& result) const override {
    LayeredHierarchy<Volume> shape_hierarchy(hierarchy_.parameters());
    shape_hierarchy.build(shape, hierarchy_.origin());
    PairCollector collector(shape, fibers, options, result);
    traverse<Volume>(shape_hierarchy, hierarchy_, has_leaf_pretest(), collector, result.counts);
    collector.finish();
  }

 private:
  static Eigen::Vector3d to_vector(Float4 corner) { return {corner[0], corner[1], corner[2]}; }

  std::uint32_t level_count() const { return hierarchy_.tree().level_count(); }

  /// Levels beyond the last give the last.
  std::uint32_t shown_level(std::uint32_t level) const {
    return level_count() == 0 ? 0 : std::min(level, level_count() - 1);
  }
  std::uint32_t level_end(std::uint32_t level) const {
    return level_count() == 0 ? 0 : hierarchy_.tree().level_end(level);
  }

  Kind hierarchy_;
};

/// DL: the layered hierarchy of k-DOPs with these k/2 unit directions, 3 to 100 of them.
std::unique_ptr<ProximityEngine> make_layered_kdop_engine(
    const std::vector<Eigen::Vector3d>& directions);

/// DS: the spatially adapted one.
std::unique_ptr<ProximityEngine> make_spatial_kdop_engine(
    const std::vector<Eigen::Vector3d>& directions);

}  // namespace fiber
