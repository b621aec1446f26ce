#pragma once

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision_object.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "fiber_proximity/environment/axis_distance.hpp"
#include "fiber_proximity/environment/environment.hpp"
#include "fiber_proximity/environment/shape_box.hpp"

namespace fiber {

/// A shape of an object where it is in the world.
struct WorldShape {
  WorldShape(const EnvironmentObject& owner, std::uint32_t object_index, std::uint32_t shape_index)
      : object(object_index),
        index(shape_index),
        shape(owner.shapes[shape_index].shape),
        pose(owner.pose * owner.shapes[shape_index].pose),
        to_shape(pose.inverse(Eigen::Isometry)),
        box(world_box(shape, pose)),
        rounding(0x1p-48 * (reach(shape) + pose.translation().cwiseAbs().maxCoeff())) {}

  std::uint32_t object;
  std::uint32_t index;  // of the shape in its object
  const Shape& shape;
  Eigen::Isometry3d pose;
  Eigen::Isometry3d to_shape;
  WorldBox box;
  double rounding;  // [m] what its place adds to the error of a distance
};

/// Finds the shapes near a box: those that end somewhere in FCL's dynamic AABB tree, the others are
/// near everything.
class Environment::BroadPhase {
 public:
  explicit BroadPhase(const std::vector<EnvironmentObject>& objects) {
    for (std::uint32_t i = 0; i < objects.size(); ++i) {
      for (std::uint32_t j = 0; j < objects[i].shapes.size(); ++j) {
        shapes_.emplace_back(objects[i], i, j);
      }
    }
    boxes_.reserve(shapes_.size());
    std::vector<fcl::CollisionObjectd*> bounded;
    for (const WorldShape& shape : shapes_) {
      if (is_bounded(shape.shape)) {
        bounded.push_back(&boxes_.emplace_back(shape.box, &shape));
      } else {
        unbounded_.push_back(&shape);
      }
    }
    tree_.registerObjects(bounded);
    tree_.setup();
  }

  /// Calls visit(shape) for the shapes near the box, nearer ones first, roughly. visit() returns
  /// how far they may be from then on [m]; boxes that overlap are never too far, unless it returns
  /// minus infinity: that ends the search.
  template <class Visit>
  void visit_near(const WorldBox& box, Visit visit) const {
    for (const WorldShape* shape : unbounded_) {
      visit(*shape);
    }
    BoxObject query(box, nullptr);
    tree_.distance(&query, &visit, &look<Visit>);
  }

 private:
  /// An object whose box is set, not computed from a geometry: FCL offers no other way to give a
  /// rotated object a tight one.
  class BoxObject final : public fcl::CollisionObjectd {
   public:
    BoxObject(const WorldBox& box, const WorldShape* shape)
        : CollisionObject(any_geometry()), shape_(shape) {
      aabb.min_ = box.min();
      aabb.max_ = box.max();
    }
    const WorldShape& shape() const { return *shape_; }

   private:
    static const std::shared_ptr<fcl::CollisionGeometryd>& any_geometry() {
      static const std::shared_ptr<fcl::CollisionGeometryd> sphere =
          std::make_shared<fcl::Sphered>(0.0);
      return sphere;
    }
    const WorldShape* shape_;
  };

  /// @param least FCL goes on to boxes that are nearer than this
  /// @return whether to end
  template <class Visit>
  static bool look(fcl::CollisionObjectd* object, fcl::CollisionObjectd* /*query*/, void* visit,
                   double& least) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double within = (*static_cast<Visit*>(visit))(static_cast<BoxObject*>(object)->shape());
    least = std::nextafter(std::max(within, 0.0), infinity);
    return within == -infinity;
  }

  std::vector<WorldShape> shapes_;
  std::vector<const WorldShape*> unbounded_;
  std::vector<BoxObject> boxes_;
  fcl::DynamicAABBTreeCollisionManagerd tree_;
};

}  // namespace fiber
