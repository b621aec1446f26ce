#include <fcl/geometry/shape/capsule.h>

#include <Eigen/Geometry>

#include "fiber_proximity/hierarchy/fiber_order.hpp"
#include "peers/fcl_manager.hpp"
#include "peers/makers.hpp"
#include "peers/peer_engine.hpp"
#include "peers/segment_boxes.hpp"

namespace fiber {
namespace {

/// What FCL's arithmetic may err by, relative to the capsule's magnitude: it takes rotations by
/// less than 1e-12 for none.
constexpr double relative_padding = 0x1p-36;
/// [m] FCL squares lengths: smaller ones would vanish.
constexpr double smallest_padding = 1e-150;

/// A segment as FCL's users write it: a capsule along z, rotated and moved into place. Its box is
/// FCL's own, that of the sphere around it unless it is upright.
class CapsuleObject final : public FclSegment {
 public:
  CapsuleObject(const std::shared_ptr<fcl::Capsuled>& capsule, std::uint32_t first_point)
      : FclSegment(capsule, first_point), capsule_(capsule) {}

  void move_to(const Capsule& segment) {
    const Eigen::Vector3d axis = segment.p1 - segment.p0;
    const double magnitude =
        segment.p0.cwiseAbs().maxCoeff() + segment.p1.cwiseAbs().maxCoeff() + segment.radius;
    capsule_->radius = segment.radius + relative_padding * magnitude + smallest_padding;
    capsule_->lz = axis.stableNorm();
    capsule_->computeLocalAABB();
    setQuatRotation(capsule_->lz > 0.0 ? Eigen::Quaterniond::FromTwoVectors(
                                             Eigen::Vector3d::UnitZ(), axis.stableNormalized())
                                       : Eigen::Quaterniond::Identity());
    setTranslation(0.5 * (segment.p0 + segment.p1));
    computeAABB();
  }

 private:
  std::shared_ptr<fcl::Capsuled> capsule_;
};

/// FCL's dynamic AABB tree over rotated capsules: what packages with deformable objects do.
class FclNaiveEngine final : public PeerEngine {
 public:
  explicit FclNaiveEngine(const BenchEngineOptions& options) : PeerEngine(options) {}

 protected:
  void do_update(const FiberAssembly& fibers, bool same_topology) override {
    if (!same_topology) {
      manager_.clear();
      objects_.clear();
      for (const std::uint32_t point : end_point_connected_order(fibers.offsets())) {
        objects_.emplace_back(std::make_shared<fcl::Capsuled>(1.0, 1.0), point);
      }
    }
    for (CapsuleObject& object : objects_) {
      object.move_to(peer_capsule(fibers, object.first_point(), margin()));
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
  std::vector<CapsuleObject> objects_;
  FclManager manager_;
};

}  // namespace

std::unique_ptr<ProximityEngine> make_fcl_naive(const BenchEngineOptions& options) {
  return std::make_unique<FclNaiveEngine>(options);
}

}  // namespace fiber
