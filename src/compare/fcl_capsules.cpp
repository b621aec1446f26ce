#include <fcl/geometry/shape/capsule.h>
#include <fcl/narrowphase/distance.h>

#include <Eigen/Geometry>
#include <cmath>
#include <exception>
#include <limits>

#include "fiber_proximity/compare/fcl_broad_phase.hpp"
#include "src/compare/fcl_manager.hpp"
#include "src/geometry/smallest_rotation.hpp"
#include "src/hierarchy/fiber_order.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

/// What FCL's boxes may err by, relative to the capsule's magnitude: it takes rotations by less
/// than 1e-12 for none.
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
  CapsuleObject(const std::shared_ptr<fcl::Capsuled>& capsule, std::uint32_t first_point)
      : FclSegment(capsule, first_point), capsule_(capsule) {}

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
  std::shared_ptr<fcl::Capsuled> capsule_;
};

double gap_of(const FclSegment& a, const FclSegment& b) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  try {
    fcl::DistanceResultd result;
    fcl::distance(&a, &b, fcl::DistanceRequestd(), result);
    // What FCL has at first says that it has found nothing.
    const bool found = std::abs(result.min_distance) < std::numeric_limits<double>::max();
    return found ? result.min_distance : none;
  } catch (const std::exception&) {
    return none;
  }
}

class Capsules final : public FclCapsules {
 public:
  explicit Capsules(double margin) : margin_(margin) {}

  void update(const FiberAssembly& fibers, bool same_topology) override {
    if (!same_topology) {
      manager_.clear();
      objects_.clear();
      for (const std::uint32_t point : end_point_connected_order(fibers.offsets())) {
        objects_.emplace_back(std::make_shared<fcl::Capsuled>(1.0, 1.0), point);
      }
    }
    for (CapsuleObject& object : objects_) {
      object.move_to(fibers.capsule(object.first_point()), margin_);
    }
    if (same_topology) {
      manager_.update();
    } else {
      manager_.build(objects_);
    }
  }

  void collide(PairCollector& collector) const override { manager_.offer(collector); }

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
    manager_.collide(call);
    return measured;
  }

 private:
  double margin_;
  std::vector<CapsuleObject> objects_;
  FclManager manager_;
};

}  // namespace

std::unique_ptr<FclCapsules> make_fcl_capsules(double margin) {
  return std::make_unique<Capsules>(margin);
}

}  // namespace fiber
