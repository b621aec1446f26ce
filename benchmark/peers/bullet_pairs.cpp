// In a module: Bullet in double has the symbols of Bullet in single precision.
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <stdexcept>

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
class BulletPairs final : public PairKernel {
 public:
  void prepare(const std::vector<HardPair>& pairs) override { make_capsules(pairs, a_, b_); }

  void run(std::size_t first, std::size_t count, double* distances) override {
    for (std::size_t i = 0; i < count; ++i) {
      distances[i] = gap(first + i);
    }
  }

  PairAnswer answer(std::size_t index) override {
    const double found = gap(index);
    if (std::isnan(found)) {
      throw std::runtime_error("no contact point");
    }
    PairAnswer answer;
    answer.distance = found + (a_[index].radius + b_[index].radius);
    answer.contact = found <= 0.0;
    return answer;
  }

 private:
  double gap(std::size_t index) {
    const BulletCapsule& a = a_[index];
    const BulletCapsule& b = b_[index];
    btGjkPairDetector detector(&a.shape, &b.shape, &simplex_, &penetration_);
    btGjkPairDetector::ClosestPointInput input;
    input.m_transformA = a.pose;
    input.m_transformB = b.pose;
    Found found;
    detector.getClosestPoints(input, found, nullptr);
    return found.gap;
  }

  btVoronoiSimplexSolver simplex_;
  btGjkEpaPenetrationDepthSolver penetration_;
  std::vector<BulletCapsule> a_;
  std::vector<BulletCapsule> b_;
};

}  // namespace
}  // namespace fiber

fiber::PairKernel* fiber_bench_make_bullet_pairs() { return new fiber::BulletPairs; }
