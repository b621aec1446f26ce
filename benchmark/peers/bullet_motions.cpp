// In a module: Bullet in double has the symbols of Bullet in single precision.
#include <BulletCollision/NarrowPhaseCollision/btContinuousConvexCollision.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkConvexCast.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include "benchmark/peers/bullet_capsule.hpp"
#include "benchmark/peers/bullet_module.hpp"
#include "benchmark/peers/translation.hpp"

namespace fiber {
namespace {

/// A capsule and where it is at the end.
struct BulletMovingCapsule : BulletCapsule {
  BulletMovingCapsule(const Eigen::Vector3d* before, const Eigen::Vector3d* after,
                      double capsule_radius)
      : BulletCapsule(before[0], before[1], capsule_radius), end(pose) {
    const Eigen::Vector3d centre = 0.5 * (after[0] + after[1]);
    end.setOrigin({centre.x(), centre.y(), centre.z()});
  }

  btTransform end;
};

/// One of Bullet's casts, in double; btCollisionWorld::convexSweepTest() takes the continuous one.
/// They stop where the gap is a millimetre, and report no overlap of capsules that move apart.
class BulletMotions final : public MovingCapsules<BulletMovingCapsule> {
 public:
  explicit BulletMotions(BulletCast cast) : cast_(cast) {}

  void run(std::size_t first, std::size_t count, ContactTime* times) override {
    for (std::size_t i = 0; i < count; ++i) {
      times[i] = found(first + i);
    }
  }

 private:
  ContactTime found(std::size_t index) {
    const btConvexShape* const shape_a = &a_[index].shape;
    const btConvexShape* const shape_b = &b_[index].shape;
    if (cast_ == BulletCast::GJK) {
      return found(index, btGjkConvexCast(shape_a, shape_b, &simplex_));
    }
    return found(index, btContinuousConvexCollision(shape_a, shape_b, &simplex_, &penetration_));
  }

  template <class Cast>
  ContactTime found(std::size_t index, Cast&& cast) const {
    btConvexCast::CastResult result;
    result.m_fraction = 1.0;  // as btCollisionWorld::convexSweepTest() has it
    const bool hit =
        cast.calcTimeOfImpact(a_[index].pose, a_[index].end, b_[index].pose, b_[index].end, result);
    return hit ? stated_time((*motions_)[index], result.m_fraction, tolerance()) : ContactTime();
  }

  const BulletCast cast_;
  btVoronoiSimplexSolver simplex_;
  btGjkEpaPenetrationDepthSolver penetration_;
};

}  // namespace
}  // namespace fiber

fiber::MotionKernel* fiber_bench_make_bullet_motions(fiber::BulletCast cast) {
  return new fiber::BulletMotions(cast);
}
