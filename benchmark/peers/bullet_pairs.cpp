// In a module: Bullet in double has the symbols of Bullet in single precision.
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include "benchmark/peers/bullet_capsule.hpp"
#include "benchmark/peers/bullet_module.hpp"

namespace fiber {
namespace {

/// The result of GJK, if there is one.
struct Found final : btDiscreteCollisionDetectorInterface::Result {
  void setShapeIdentifiersA(int /*part*/, int /*index*/) override {}
  void setShapeIdentifiersB(int /*part*/, int /*index*/) override {}
  void addContactPoint(const btVector3& /*normal*/, const btVector3& /*point*/,
                       btScalar depth) override {
    gap = depth;
  }

  double gap = std::numeric_limits<double>::quiet_NaN();  // of the surfaces [m]
};

/// btGjkPairDetector with EPA behind it, as in Bullet's default configuration, in double.
class BulletPairs final : public CapsulePairs<BulletCapsule> {
 public:
  void run(std::size_t first, std::size_t count, double* distances) override {
    for (std::size_t i = 0; i < count; ++i) {
      distances[i] = gap(first + i);
    }
  }

 private:
  double gap(std::size_t index) override {
    btGjkPairDetector detector(&a_[index].shape, &b_[index].shape, &simplex_, &penetration_);
    btGjkPairDetector::ClosestPointInput input;
    input.m_transformA = a_[index].pose;
    input.m_transformB = b_[index].pose;
    Found found;
    detector.getClosestPoints(input, found, nullptr);
    return found.gap;
  }

  btVoronoiSimplexSolver simplex_;
  btGjkEpaPenetrationDepthSolver penetration_;
};

}  // namespace
}  // namespace fiber

fiber::PairKernel* fiber_bench_make_bullet_pairs() { return new fiber::BulletPairs; }
