#include <fcl/geometry/shape/sphere.h>

#include "fiber_proximity/compare/fcl_broad_phase.hpp"
#include "src/compare/fcl_manager.hpp"
#include "src/hierarchy/segment_boxes.hpp"

namespace fiber {
namespace {

/// An object whose box is set, not computed from a geometry.
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

class Boxes final : public FclBroadPhase {
 public:
  explicit Boxes(double margin) : boxes_(margin) {}

  void update(const FiberAssembly& fibers, bool same_topology) override {
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

  void collide(PairCollector& collector) const override { manager_.offer(collector); }

 private:
  SegmentBoxes boxes_;
  std::shared_ptr<fcl::CollisionGeometryd> geometry_ = std::make_shared<fcl::Sphered>(0.0);
  std::vector<BoxObject> objects_;
  FclManager manager_;
};

}  // namespace

std::unique_ptr<FclBroadPhase> make_fcl_boxes(double margin) {
  return std::make_unique<Boxes>(margin);
}

}  // namespace fiber
