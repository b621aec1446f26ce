#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision_object.h>

#include "fiber_proximity/query/pair_collector.hpp"
#include "peers/fcl_manager.hpp"
#include "peers/makers.hpp"
#include "peers/peer_engine.hpp"
#include "peers/segment_boxes.hpp"

namespace fiber {
namespace {

/// An object whose box is set, not computed from a geometry: FCL offers no other way to give a
/// rotated object a tight one.
class BoxObject final : public FclSegment {
 public:
  BoxObject(const std::shared_ptr<fcl::CollisionGeometryd>& geometry, std::uint32_t first_point)
      : FclSegment(geometry, first_point) {}

  void set_box(const Aabb& box) {
    for (int axis = 0; axis < 3; ++axis) {
      aabb.min_[axis] = static_cast<double>(box.lower[axis]);
      aabb.max_[axis] = static_cast<double>(box.upper[axis]);
    }
  }
};

/// FCL's dynamic AABB tree over the boxes of the segments.
class FclEngine final : public PeerEngine {
 public:
  explicit FclEngine(const BenchEngineOptions& options)
      : PeerEngine(options), boxes_(options.margin) {}

 protected:
  void do_update(const FiberAssembly& fibers, bool same_topology) override {
    boxes_.update(fibers, same_topology);
    if (!same_topology) {
      manager_.clear();
      objects_.clear();
      for (const std::uint32_t point : boxes_.points()) {
        objects_.emplace_back(geometry_, point);
      }
    }
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      objects_[i].set_box(boxes_[i]);
    }
    if (same_topology) {
      manager_.update();
    } else {
      manager_.build(objects_);
    }
  }

  void collide(const FiberAssembly& fibers, const QueryOptions& options,
               QueryResult& result) const override {
    PairCollector collector(fibers, options, result);
    manager_.collide(collector);
    collector.finish();
  }

 private:
  SegmentBoxes boxes_;
  std::shared_ptr<fcl::CollisionGeometryd> geometry_ = std::make_shared<fcl::Sphered>(0.0);
  std::vector<BoxObject> objects_;
  FclManager manager_;
};

}  // namespace

std::unique_ptr<ProximityEngine> make_fcl(const BenchEngineOptions& options) {
  return std::make_unique<FclEngine>(options);
}

}  // namespace fiber
