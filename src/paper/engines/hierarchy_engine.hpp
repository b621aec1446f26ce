#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "fiber_proximity/query/engine.hpp"
#include "src/bounds/aabb.hpp"
#include "src/bounds/bounding_volume.hpp"
#include "src/paper/engines/traverse.hpp"
#include "src/paper/hierarchy/layered_hierarchy.hpp"

namespace fiber {

/// One of the paper's hierarchies as an engine.
/// @tparam Kind a hierarchy with build(fibers, origin) and update(fibers, origin)
template <class Kind>
class HierarchyEngine final : public ProximityEngine {
 public:
  using Volume = typename Kind::Volume;

  explicit HierarchyEngine(Kind hierarchy) : hierarchy_(std::move(hierarchy)) {}

  std::uint32_t level_count() const override { return hierarchy_.tree().level_count(); }

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

  std::uint64_t recomputed_count() const override { return hierarchy_.recomputed_count(); }

  std::size_t memory_bytes() const override { return hierarchy_.memory_bytes(); }

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
    traverse<Volume>(hierarchy_, hierarchy_, options, collector, result.counts);
    collector.finish();
  }

  void do_query_shape(const FiberAssembly& shape, const FiberAssembly& fibers,
                      const QueryOptions& options, QueryResult& result) const override {
    LayeredHierarchy<Volume> shape_hierarchy(hierarchy_.parameters());
    shape_hierarchy.build(shape, hierarchy_.origin());
    PairCollector collector(shape, fibers, options, result);
    traverse<Volume>(shape_hierarchy, hierarchy_, options, collector, result.counts);
    collector.finish();
  }

 private:
  static Eigen::Vector3d to_vector(Float4 corner) { return {corner[0], corner[1], corner[2]}; }

  /// Levels beyond the last give the last.
  std::uint32_t shown_level(std::uint32_t level) const {
    return level_count() == 0 ? 0 : std::min(level, level_count() - 1);
  }
  std::uint32_t level_end(std::uint32_t level) const {
    return level_count() == 0 ? 0 : hierarchy_.tree().level_end(level);
  }

  Kind hierarchy_;
};

}  // namespace fiber
