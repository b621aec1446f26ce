// Rods under loads against theory.

#include <gtest/gtest.h>

#include "validation/sim/loads.hpp"

namespace fiber::test {
namespace {

constexpr double half_percent = 0.005;

TEST(LoadTheory, AMomentBendsARodToAnArcOfACircle) {
  for (const double moment : {0.5 * M_PI, M_PI, 2.0 * M_PI}) {
    SCOPED_TRACE(moment);
    const CantileverTip exact = exact_arc_tip(moment);
    const CantileverTip tip = simulated_arc_tip(50, moment);
    EXPECT_NEAR(tip.drop, exact.drop, half_percent);
    EXPECT_NEAR(tip.reach, exact.reach, half_percent);
  }
}

/// The step is at a node, and inside of an edge.
TEST(LoadTheory, ASteppedCantileverBendsAsItsParts) {
  for (const double step : {0.4, 0.473}) {
    SCOPED_TRACE(step);
    const CantileverTip exact = exact_stepped_arc_tip(2.0, step);
    const CantileverTip tip = simulated_stepped_arc_tip(50, 2.0, step);
    EXPECT_NEAR(tip.drop, exact.drop, half_percent * exact.drop);
    EXPECT_NEAR(tip.reach, exact.reach, half_percent * exact.reach);
    const double compliance = exact_stepped_compliance(step);
    EXPECT_NEAR(simulated_stepped_compliance(50, step), compliance, half_percent * compliance);
  }
}

TEST(LoadTheory, AChainWithAWeightHangsInTwoCatenaries) {
  const HangingChain plain = exact_catenary(1.2);
  const HangingChain none = exact_loaded_catenary(1.2, 0.0, 0.5);
  EXPECT_NEAR(none.sag, plain.sag, 1e-9);
  EXPECT_NEAR(none.pull, plain.pull, 1e-9);
  for (const double place : {0.5, 0.2}) {
    for (const double weight : {0.3, 3.0}) {
      SCOPED_TRACE(std::to_string(weight) + " at " + std::to_string(place));
      const HangingChain exact = exact_loaded_catenary(1.2, weight, place);
      const HangingChain chain = simulated_loaded_catenary(1.2, weight, place, 50);
      EXPECT_NEAR(chain.sag, exact.sag, half_percent * exact.sag);
      EXPECT_NEAR(chain.pull, exact.pull, half_percent * exact.pull);
    }
  }
}

TEST(LoadTheory, AWeightOnALightCableSwingsAsAPendulum) {
  constexpr double thousandth = 0.001;
  for (const double angle : {0.1, 0.8}) {
    SCOPED_TRACE(angle);
    const double exact = exact_weight_pendulum_period(angle, 0.01);
    EXPECT_NEAR(simulated_weight_pendulum_period(20, angle, 0.01, 0.005), exact,
                thousandth * exact);
  }
}

}  // namespace
}  // namespace fiber::test
