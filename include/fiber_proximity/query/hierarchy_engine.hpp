#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/hierarchy/hierarchy.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/query/traverse.hpp"

namespace fiber {

/// One of the paper's hierarchies as an engine.
template <class Volume>
class HierarchyEngine final : public ProximityEngine {
 public:
  std::uint32_t level_count() const override { return hierarchy_.tree().level_count(); }

  void level_boxes(std::uint32_t level, std::vector<NodeBox>& boxes) const override {
    boxes.clear();
    if (hierarchy_.tree().empty()) {
      return;
    }
    const std::uint32_t shown = std::min(level, level_count() - 1);
    for (std::uint32_t node = hierarchy_.tree().level_begin(shown);
         node < hierarchy_.tree().level_end(shown); ++node) {
      const Aabb box = bounding_box(hierarchy_.volume(node));
      boxes.push_back({hierarchy_.origin() + Eigen::Vector3f(box.lower.data()).cast<double>(),
                       hierarchy_.origin() + Eigen::Vector3f(box.upper.data()).cast<double>()});
    }
  }

 protected:
  void do_update(const FiberAssembly& fibers, bool same_topology) override {
    // The first point as the origin: near all others in any scene single precision can serve, and
    // the same for the same input.
    const Eigen::Vector3d origin =
        fibers.points().empty() ? Eigen::Vector3d::Zero() : fibers.points().front();
    if (same_topology) {
      hierarchy_.update(fibers, origin);
    } else {
      hierarchy_.build(fibers, origin);
    }
  }

  void do_query(const FiberAssembly& fibers, const QueryOptions& options,
                QueryResult& result) const override {
    PairCollector collector(fibers, options, result);
    traverse(hierarchy_, hierarchy_, collector, result.counts);
    collector.finish();
  }

  void do_query_shape(const FiberAssembly& shape, const FiberAssembly& fibers,
                      const QueryOptions& options, QueryResult& result) const override {
    Hierarchy<Volume> shape_hierarchy;
    shape_hierarchy.build(shape, hierarchy_.origin());
    PairCollector collector(shape, fibers, options, result);
    traverse(shape_hierarchy, hierarchy_, collector, result.counts);
    collector.finish();
  }

 private:
  Hierarchy<Volume> hierarchy_;
};

}  // namespace fiber
