#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/distance.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <deque>
#include <map>
#include <string>

#include "benchmark/environment/cell_checker.hpp"
#include "benchmark/environment/fcl_shapes.hpp"
#include "src/geometry/smallest_rotation.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;
using Manager = fcl::DynamicAABBTreeCollisionManagerd;

/// The kind of an object of FCL.
struct Label {
  bool is_segment;
  std::uint32_t index;
};

const Label& label(const fcl::CollisionObjectd& object) {
  return *static_cast<const Label*>(object.getUserData());
}

/// Objects of FCL with labels, and the tree over them.
class FclObjects {
 public:
  explicit FclObjects(bool are_segments) : are_segments_(are_segments) {}

  void add(const std::shared_ptr<fcl::CollisionGeometryd>& geometry,
           const Eigen::Isometry3d& pose) {
    labels_.push_back({are_segments_, static_cast<std::uint32_t>(objects_.size())});
    objects_.emplace_back(geometry, pose);
    objects_.back().setUserData(&labels_.back());
  }

  void build() {
    std::vector<fcl::CollisionObjectd*> objects;
    for (fcl::CollisionObjectd& object : objects_) {
      objects.push_back(&object);
    }
    manager_.registerObjects(objects);
    manager_.setup();
  }

  void move(std::uint32_t object, const Eigen::Isometry3d& pose) {
    objects_[object].setTransform(pose);
    objects_[object].computeAABB();
  }

  const fcl::CollisionObjectd& operator[](std::uint32_t object) const { return objects_[object]; }
  Manager& manager() { return manager_; }

 private:
  const bool are_segments_;
  std::deque<Label> labels_;  // these and the objects stay where they are
  std::deque<fcl::CollisionObjectd> objects_;
  Manager manager_;
};

/// Segments as capsules along z, rotated and moved into place.
class FclSegments {
 public:
  /// @param padding [m] by which they are thicker
  FclSegments(const FiberAssembly& cables, double padding) : objects_(true) {
    for (std::size_t fiber = 0; fiber < cables.fiber_count(); ++fiber) {
      for (std::uint32_t i = cables.offsets()[fiber]; i + 1 < cables.offsets()[fiber + 1]; ++i) {
        capsules_.push_back(
            std::make_shared<fcl::Capsuled>(cables.segment_radius(i) + padding, 1.0));
        first_points_.push_back(i);
        objects_.add(capsules_.back(), Eigen::Isometry3d::Identity());
      }
    }
    move(cables);
    objects_.build();
  }

  void move(const FiberAssembly& cables) {
    for (std::uint32_t i = 0; i < capsules_.size(); ++i) {
      const Capsule capsule = cables.capsule(first_points_[i]);
      const Vector3d axis = capsule.p1 - capsule.p0;
      capsules_[i]->lz = axis.norm();
      capsules_[i]->computeLocalAABB();
      Eigen::Isometry3d pose(smallest_rotation(Vector3d::UnitZ(), axis));
      pose.translation() = 0.5 * (capsule.p0 + capsule.p1);
      objects_.move(i, pose);
    }
  }

  const fcl::CollisionObjectd& operator[](std::uint32_t i) const { return objects_[i]; }
  std::uint32_t first_point(std::uint32_t i) const { return first_points_[i]; }
  Manager& manager() { return objects_.manager(); }

 private:
  std::vector<std::shared_ptr<fcl::Capsuled>> capsules_;
  std::vector<std::uint32_t> first_points_;
  FclObjects objects_;
};

class FclChecker final : public CellChecker {
 public:
  FclChecker(const std::vector<EnvironmentObject>& objects, const FiberAssembly& cables,
             const CellQuestions& questions)
      : margin_(questions.margin),
        segments_(cables, 0.0),
        padded_(cables, margin_),
        objects_(false) {
    for (const EnvironmentObject& object : objects) {
      names_.emplace(object.name, static_cast<std::uint32_t>(names_.size()));
      objects_.add(fcl_shape(object.shapes.front().shape),
                   object.pose * object.shapes.front().pose);
    }
    objects_.build();
  }

  void move_objects(const std::vector<ObjectChange>& moves) override {
    for (const ObjectChange& move : moves) {
      objects_.move(names_.at(move.object.name), move.object.pose);
    }
    objects_.manager().update();
  }

  void move_cables(const FiberAssembly& cables) override {
    segments_.move(cables);
    segments_.manager().update();
    padded_.move(cables);
    padded_.manager().update();
  }

  void find_self_contacts() override {
    answer_.self_contacts.clear();
    padded_.manager().collide(this, offer_segments);
  }

  void find_contacts() override {
    answer_.contacts.clear();
    padded_.manager().collide(&objects_.manager(), this, offer_object);
  }

  void find_nearest() override {
    nearest_ = fcl::DefaultDistanceData<double>();
    segments_.manager().distance(&objects_.manager(), this, look);
    answer_.nearest = nearest_.result.min_distance;
  }

  CellAnswer answer() const override {
    CellAnswer sorted = answer_;
    sort_pairs(sorted.self_contacts);
    sort_pairs(sorted.contacts);
    return sorted;
  }

  std::uint64_t exception_count() const override { return exceptions_; }

 private:
  static bool offer_segments(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
    FclChecker& checker = *static_cast<FclChecker*>(data);
    const auto [i, j] = std::minmax({label(*a).index, label(*b).index});
    const std::uint32_t first = checker.segments_.first_point(i);
    const std::uint32_t second = checker.segments_.first_point(j);
    if (second - first > 1) {  // neighbours share a point
      checker.keep_near(checker.segments_[i], checker.segments_[j], first, second,
                        checker.answer_.self_contacts);
    }
    return false;  // go on
  }

  static bool offer_object(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
    FclChecker& checker = *static_cast<FclChecker*>(data);
    const bool ordered = label(*a).is_segment;
    const std::uint32_t segment = label(ordered ? *a : *b).index;
    const std::uint32_t object = label(ordered ? *b : *a).index;
    checker.keep_near(checker.segments_[segment], checker.objects_[object],
                      checker.segments_.first_point(segment), object, checker.answer_.contacts);
    return false;
  }

  /// FCL's own callback, and what it throws.
  static bool look(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data, double& least) {
    FclChecker& checker = *static_cast<FclChecker*>(data);
    try {
      return fcl::DefaultDistanceFunction(a, b, &checker.nearest_, least);
    } catch (const std::exception&) {
      ++checker.exceptions_;
      least = checker.nearest_.result.min_distance;
      return false;
    }
  }

  void keep_near(const fcl::CollisionObjectd& a, const fcl::CollisionObjectd& b,
                 std::uint32_t first, std::uint32_t second, std::vector<FoundPair>& pairs) {
    fcl::DistanceResultd result;
    try {
      fcl::distance(&a, &b, fcl::DistanceRequestd(), result);
    } catch (const std::exception&) {
      ++exceptions_;
      return;
    }
    if (result.min_distance <= margin_) {
      pairs.push_back({first, second, result.min_distance});
    }
  }

  const double margin_;
  FclSegments segments_;
  FclSegments padded_;
  FclObjects objects_;
  std::map<std::string, std::uint32_t> names_;
  fcl::DefaultDistanceData<double> nearest_;
  CellAnswer answer_;
  std::uint64_t exceptions_ = 0;
};

}  // namespace

std::unique_ptr<CellChecker> make_fcl_checker(const std::vector<EnvironmentObject>& objects,
                                              const FiberAssembly& cables,
                                              const CellQuestions& questions) {
  return std::make_unique<FclChecker>(objects, cables, questions);
}

}  // namespace fiber
