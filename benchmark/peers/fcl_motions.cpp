#include <fcl/narrowphase/continuous_collision.h>

#include "benchmark/kernels/makers.hpp"
#include "benchmark/peers/fcl_capsule.hpp"
#include "benchmark/peers/translation.hpp"

namespace fiber {
namespace {

/// A capsule and where it is at the end.
struct FclMovingCapsule : FclCapsule {
  FclMovingCapsule(const Eigen::Vector3d* before, const Eigen::Vector3d* after, double radius)
      : FclCapsule(before[0], before[1], radius), end(pose) {
    end.translation() = 0.5 * (after[0] + after[1]);
  }

  fcl::Transform3d end;
};

/// fcl::continuousCollide() of two capsules.
class FclMotions final : public MovingCapsules<FclMovingCapsule> {
 public:
  explicit FclMotions(const fcl::ContinuousCollisionRequestd& request) : request_(request) {}

  void run(std::size_t first, std::size_t count, ContactTime* times) override {
    for (std::size_t i = first; i < first + count; ++i) {
      fcl::ContinuousCollisionResultd result;
      fcl::continuousCollide(&a_[i].capsule, a_[i].pose, a_[i].end, &b_[i].capsule, b_[i].pose,
                             b_[i].end, request_, result);
      times[i - first] =
          result.is_collide ? answer((*motions_)[i], result.time_of_contact) : ContactTime();
    }
  }

 private:
  ContactTime answer(const HardMotion& motion, double time) const {
    if (request_.ccd_solver_type != fcl::CCDC_NAIVE) {
      return stated_time(motion, time, tolerance());
    }
    // Looks at times that are as far from each other as this.
    const double step = 1.0 / (static_cast<double>(request_.num_max_iterations) - 1.0);
    return {true, std::max(0.0, time - step), time, true};
  }

  const fcl::ContinuousCollisionRequestd request_;
};

}  // namespace

std::unique_ptr<MotionKernel> make_fcl_advancement_motions() {
  fcl::ContinuousCollisionRequestd request;
  request.ccd_motion_type = fcl::CCDM_TRANS;
  request.ccd_solver_type = fcl::CCDC_CONSERVATIVE_ADVANCEMENT;
  return std::make_unique<FclMotions>(request);
}

std::unique_ptr<MotionKernel> make_fcl_naive_motions() {
  return std::make_unique<FclMotions>(fcl::ContinuousCollisionRequestd());
}

}  // namespace fiber
