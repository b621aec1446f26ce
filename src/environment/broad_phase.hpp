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

#include "fiber_proximity/environment/environment.hpp"
#include "src/environment/world_shape.hpp"

namespace fiber {

/// Consecutive segments of one fibre, whose box is looked up at once.
struct SegmentRun {
  std::uint32_t fiber;
  std::uint32_t begin;  // first points of the segments
  std::uint32_t end;
  WorldBox box;         // around their axes, wherever these are [m]
  double radius = 0.0;  // the largest [m]
};

/// Calls look(run) for each run of the fibres' segments that begins at one of these points, until
/// the query is done().
/// @tparam Query says how many segments a run has, what box the axes from a point to another are in
///               and how thick a segment is
template <class Query, class Look>
void for_each_run(const FiberAssembly& fibers, PointRange points, Query& query, const Look& look) {
  constexpr std::uint32_t length = Query::segments_per_run;
  const std::vector<std::uint32_t>& offsets = fibers.offsets();
  const auto after = std::upper_bound(offsets.begin(), offsets.end(), points.begin);
  for (auto fiber = static_cast<std::uint32_t>(after - offsets.begin()) - 1;
       fiber < fibers.fiber_count() && offsets[fiber] < points.end && !query.done(); ++fiber) {
    const std::uint32_t last = offsets[fiber + 1] - 1;
    const std::uint32_t before = std::max(points.begin, offsets[fiber]) - offsets[fiber];
    for (std::uint32_t first = offsets[fiber] + (before + length - 1) / length * length;
         first < std::min(last, points.end) && !query.done(); first += length) {
      SegmentRun run{fiber, first, std::min(first + length, last), {}};
      run.box = query.box_of(run.begin, run.end);
      for (std::uint32_t point = run.begin; point < run.end; ++point) {
        run.radius = std::max(run.radius, query.radius_of(point));
      }
      look(run);
    }
  }
}

/// All points of the fibres.
inline PointRange all_points(const FiberAssembly& fibers) {
  return {0, static_cast<std::uint32_t>(fibers.point_count())};
}

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

  /// By object, then by their index in it.
  const std::vector<WorldShape>& shapes() const { return shapes_; }

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
