// Friction against closed forms: an inclined plane.

#include <gtest/gtest.h>

#include <cmath>

#include "fiber_proximity/sim/contacts.hpp"
#include "validation/sim/contact_scenes.hpp"
#include "validation/sim/elastica.hpp"
#include "validation/sim/friction_scenes.hpp"

namespace fiber::test {
namespace {

class Coefficient : public testing::TestWithParam<double> {};

TEST_P(Coefficient, ARodSticksOnSlopesBelowIt) {
  Incline incline(std::atan(0.98 * GetParam()), GetParam());
  incline.run(2.0);
  EXPECT_LT(std::abs(incline.speed()), 1e-3);
}

TEST_P(Coefficient, ARodSlidesDownSlopesAboveIt) {
  for (const double excess : {1.02, 1.5, 3.0}) {
    const double angle = std::atan(excess * GetParam());
    Incline incline(angle, GetParam());
    incline.run(0.5);
    const double before = incline.speed();
    incline.run(1.0);
    const double expected = standard_gravity * (std::sin(angle) - GetParam() * std::cos(angle));
    // Weight and friction nearly balance just above the angle: their own error counts.
    EXPECT_NEAR(incline.speed() - before, expected, 2e-3 * standard_gravity * std::sin(angle))
        << "slope / " << excess;
  }
}

INSTANTIATE_TEST_SUITE_P(OfFriction, Coefficient, testing::Values(0.1, 0.2, 0.3));

TEST_P(Coefficient, ATipThatIsPushedOntoAPlaneSlidesWhereTheElasticaSays) {
  const double theory = lowering_until_tip_slides(GetParam(), 0.0);
  EXPECT_NEAR(lowering_of_simulated_tip(GetParam(), 50), theory, 0.02 * theory);
}

TEST(Friction, TheLawHasTheDerivativesItTellsAlsoWhereSlippingBegins) {
  constexpr double stick_length = 1e-3;
  constexpr double step = 1e-8;
  for (const double share : {0.3, 0.9, 1.0, 1.5}) {
    const double slip = share * stick_length;
    const Friction::Law law = Friction::law(slip, stick_length);
    const Friction::Law less = Friction::law(slip - step, stick_length);
    const Friction::Law more = Friction::law(slip + step, stick_length);
    EXPECT_NEAR((more.energy - less.energy) / (2.0 * step), law.resistance * slip, 1e-4) << share;
    const double rise = more.resistance * (slip + step) - less.resistance * (slip - step);
    EXPECT_NEAR(rise / (2.0 * step), law.curvature, 1e-3 / stick_length) << share;
  }
}

TEST(Friction, WithoutACoefficientNothingSticks) {
  Incline incline(0.1, 0.0);
  incline.run(1.0);
  EXPECT_NEAR(incline.speed(), standard_gravity * std::sin(0.1), 1e-3);
}

}  // namespace
}  // namespace fiber::test
