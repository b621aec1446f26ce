#pragma once

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/narrowphase/collision_object.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "fiber_proximity/query/pair_collector.hpp"

namespace fiber {

/// A collision object that knows which segment it is.
class FclSegment : public fcl::CollisionObjectd {
 public:
  FclSegment(const std::shared_ptr<fcl::CollisionGeometryd>& geometry, std::uint32_t first_point)
      : CollisionObject(geometry), first_point_(first_point) {}

  std::uint32_t first_point() const { return first_point_; }

 private:
  std::uint32_t first_point_;
};

/// FCL's dynamic AABB tree over objects that are FclSegments.
class FclManager {
 public:
  /// Forgets the objects; they may be destroyed then.
  void clear() { manager_.clear(); }

  /// Builds the tree; the objects must stay where they are until it is cleared.
  template <class Segment>
  void build(std::vector<Segment>& segments) {
    std::vector<fcl::CollisionObjectd*> objects;
    for (Segment& segment : segments) {
      objects.push_back(&segment);
    }
    manager_.registerObjects(objects);
    manager_.setup();
  }

  /// Refits the tree to the objects' boxes.
  void update() { manager_.update(); }

  /// Calls call(a, b) with all pairs of objects whose boxes overlap.
  template <class Call>
  void collide(Call& call) const {
    if (manager_.size() > 1) {
      manager_.collide(&call, [](fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
        (*static_cast<Call*>(data))(*static_cast<const FclSegment*>(a),
                                    *static_cast<const FclSegment*>(b));
        return false;  // go on
      });
    }
  }

  /// Offers them to the collector.
  void offer(PairCollector& collector) const {
    auto call = [&collector](const FclSegment& a, const FclSegment& b) {
      collector.offer(a.first_point(), b.first_point());
    };
    collide(call);
  }

 private:
  fcl::DynamicAABBTreeCollisionManagerd manager_;
};

}  // namespace fiber
