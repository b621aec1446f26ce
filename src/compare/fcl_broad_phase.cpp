#include "src/compare/fcl_broad_phase.hpp"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/distance.h>

#include <Eigen/Geometry>
#include <cmath>
#include <exception>
#include <limits>

#include "src/geometry/smallest_rotation.hpp"
#include "src/hierarchy/fiber_order.hpp"
#include "src/hierarchy/segment_boxes.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

/// A collision object that knows which segment it is.
class FclSegment : public fcl::CollisionObjectd {
 public:
  FclSegment(const std::shared_ptr<fcl::CollisionGeometryd>& geometry, std::uint32_t first_point)
      : CollisionObject(geometry), first_point_(first_point) {}

  std::uint32_t first_point() const { return first_point_; }

 private:
  std::uint32_t first_point_;
};

/// FCL's tree over objects that are FclSegments, each of which its first point makes.
template <class Base, class Object>
class Tree : public Base {
 public:
  void update(const FiberAssembly& fibers, bool same_topology) override {
    if (!same_topology) {
      manager_.clear();  // which refers to the objects
      objects_.clear();
      for (const std::uint32_t point : order_of(fibers)) {
        objects_.emplace_back(point);
      }
    }
    place(fibers, objects_);
    if (same_topology) {
      manager_.update();
      return;
    }
    std::vector<fcl::CollisionObjectd*> objects;
    for (Object& object : objects_) {
      objects.push_back(&object);
    }
    manager_.registerObjects(objects);
    manager_.setup();
  }

  void collide(PairCollector& collector) const override {
    auto call = [&collector](const FclSegment& a, const FclSegment& b) {
      collector.offer(a.first_point(), b.first_point());
    };
    for_each_pair(call);
  }

 protected:
  /// The segments by their first points, neighbours of the tree beside each other.
  virtual std::vector<std::uint32_t> order_of(const FiberAssembly& fibers) const = 0;
  virtual void place(const FiberAssembly& fibers, std::vector<Object>& objects) const = 0;

  /// Calls call(a, b) with all pairs of objects whose boxes overlap.
  template <class Call>
  void for_each_pair(Call& call) const {
    if (manager_.size() > 1) {
      manager_.collide(&call, [](fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
        (*static_cast<Call*>(data))(*static_cast<const FclSegment*>(a),
                                    *static_cast<const FclSegment*>(b));
        return false;  // go on
      });
    }
  }

 private:
  std::vector<Object> objects_;
  fcl::DynamicAABBTreeCollisionManagerd manager_;
};

/// An object whose box is set, not computed from a geometry.
class BoxObject final : public FclSegment {
 public:
  explicit BoxObject(std::uint32_t first_point) : FclSegment(any_geometry(), first_point) {}

  void set_box(const Aabb& box) {
    for (int axis = 0; axis < 3; ++axis) {
      aabb.min_[axis] = static_cast<double>(box.lower[axis]);
      aabb.max_[axis] = static_cast<double>(box.upper[axis]);
    }
  }

 private:
  static const std::shared_ptr<fcl::CollisionGeometryd>& any_geometry() {
    static const std::shared_ptr<fcl::CollisionGeometryd> sphere =
        std::make_shared<fcl::Sphered>(0.0);
    return sphere;
  }
};

class Boxes final : public Tree<FclBroadPhase, BoxObject> {
 public:
  explicit Boxes(double margin) : boxes_(margin) {}

  void update(const FiberAssembly& fibers, bool same_topology) override {
    boxes_.update(fibers, same_topology);
    Tree::update(fibers, same_topology);
  }

 private:
  std::vector<std::uint32_t> order_of(const FiberAssembly& /*fibers*/) const override {
    return boxes_.points();
  }
  void place(const FiberAssembly& /*fibers*/, std::vector<BoxObject>& objects) const override {
    for (std::size_t i = 0; i < objects.size(); ++i) {
      objects[i].set_box(boxes_[i]);
    }
  }

  SegmentBoxes boxes_;
};

/// The error that FCL's boxes may have, relative to the capsule's magnitude: it takes rotations by
/// less than 1e-12 for none.
constexpr double relative_padding = 0x1p-36;
/// [m] FCL squares lengths: smaller ones would vanish.
constexpr double smallest_padding = 1e-150;

/// The rotation from the z axis to a segment's. A capsule is the same upside down: for an axis that
/// points down Eigen loses up to half the digits.
Eigen::Quaterniond rotation_to(const Vector3d& axis) {
  if (axis.isZero(0.0)) {
    return Eigen::Quaterniond::Identity();
  }
  // Twice: the length of a tiny axis has few digits.
  const Vector3d along = axis.stableNormalized().normalized();
  return smallest_rotation(Vector3d::UnitZ(), along.z() < 0.0 ? Vector3d(-along) : along);
}

class CapsuleObject final : public FclSegment {
 public:
  explicit CapsuleObject(std::uint32_t first_point)
      : CapsuleObject(first_point, std::make_shared<fcl::Capsuled>(1.0, 1.0)) {}

  /// @param margin [m] of which each box takes half
  void move_to(const Capsule& segment, double margin) {
    const Vector3d axis = segment.p1 - segment.p0;
    capsule_->radius = segment.radius;
    capsule_->lz = axis.stableNorm();
    capsule_->computeLocalAABB();
    setQuatRotation(rotation_to(axis));
    setTranslation(0.5 * (segment.p0 + segment.p1));
    computeAABB();
    const double magnitude =
        segment.p0.cwiseAbs().maxCoeff() + segment.p1.cwiseAbs().maxCoeff() + segment.radius;
    const double more = 0.5 * margin + relative_padding * magnitude + smallest_padding;
    aabb.min_ -= Vector3d::Constant(more);
    aabb.max_ += Vector3d::Constant(more);
  }

 private:
  CapsuleObject(std::uint32_t first_point, const std::shared_ptr<fcl::Capsuled>& capsule)
      : FclSegment(capsule, first_point), capsule_(capsule) {}

  std::shared_ptr<fcl::Capsuled> capsule_;
};

double gap_of(const FclSegment& a, const FclSegment& b) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  try {
    fcl::DistanceResultd result;
    fcl::distance(&a, &b, fcl::DistanceRequestd(), result);
    // The initial value of FCL says that it has found nothing.
    const bool found = std::abs(result.min_distance) < std::numeric_limits<double>::max();
    return found ? result.min_distance : none;
  } catch (const std::exception&) {
    return none;
  }
}

class Capsules final : public Tree<FclCapsules, CapsuleObject> {
 public:
  explicit Capsules(double margin) : margin_(margin) {}

  std::uint64_t measure(const NarrowPhase& test, std::vector<FclDistance>& found) const override {
    std::uint64_t measured = 0;
    found.clear();
    auto call = [&](const FclSegment& a, const FclSegment& b) {
      const PointPair pair = test.ordered({a.first_point(), b.first_point()});
      if (!test.is_left_out(pair)) {
        ++measured;
        const double gap = gap_of(a, b);
        if (!(gap > test.margin()) && !test.lacks_loop(pair)) {
          found.push_back({pair, gap});
        }
      }
    };
    this->for_each_pair(call);
    return measured;
  }

 private:
  std::vector<std::uint32_t> order_of(const FiberAssembly& fibers) const override {
    return end_point_connected_order(fibers.offsets());
  }
  void place(const FiberAssembly& fibers, std::vector<CapsuleObject>& objects) const override {
    for (CapsuleObject& object : objects) {
      object.move_to(fibers.capsule(object.first_point()), margin_);
    }
  }

  double margin_;
};

}  // namespace

std::unique_ptr<FclBroadPhase> make_fcl_boxes(double margin) {
  return std::make_unique<Boxes>(margin);
}

std::unique_ptr<FclCapsules> make_fcl_capsules(double margin) {
  return std::make_unique<Capsules>(margin);
}

}  // namespace fiber
