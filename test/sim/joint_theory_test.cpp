// Joined and closed rods against theory.

#include <gtest/gtest.h>

#include "validation/sim/joints.hpp"

namespace fiber::test {
namespace {

TEST(JointTheory, ARingHangsAsItsElastica) {
  EXPECT_NEAR(exact_hung_ring(0.0).drop, 1.0 / M_PI, 1e-6);
  EXPECT_NEAR(exact_hung_ring(0.0).width, 1.0 / M_PI, 1e-6);
  for (const double weight : {20.0, 100.0, 500.0}) {
    SCOPED_TRACE(weight);
    constexpr double half_percent = 0.005;
    const HungRing exact = exact_hung_ring(weight);
    const HungRing ring = simulated_hung_ring(weight, 60);
    EXPECT_GT(exact.drop, 1.01 / M_PI);
    EXPECT_NEAR(ring.drop, exact.drop, half_percent * exact.drop);
    EXPECT_NEAR(ring.width, exact.width, half_percent * exact.width);
  }
}

TEST(JointTheory, ATrussPullsAtItsJoint) {
  const auto exact = exact_truss();
  const auto truss = simulated_truss();
  for (std::size_t i = 0; i < exact.size(); ++i) {
    EXPECT_NEAR(truss[i], exact[i], 1e-3 * exact[i]);
  }
}

}  // namespace
}  // namespace fiber::test
