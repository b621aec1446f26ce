// Friction against closed forms: an inclined plane.

#include <gtest/gtest.h>

#include <cmath>

#include "fiber_proximity/sim/contacts.hpp"
#include "validation/sim/elastica.hpp"
#include "validation/sim/friction_scenes.hpp"
#include "validation/sim/moving_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

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

/// A stick that leans and hangs from its upper end is dragged outwards at the lower one: friction
/// lifts it, by twice as much as the force that presses and that friction goes by. The balance of
/// moments about the pin tells the force.
TEST(Friction, LiftsBySteepSticksMoreThanTheForceItGoesBy) {
  constexpr double height = 0.4;
  constexpr double reach = 0.1;
  constexpr double coefficient = 0.5;
  constexpr double radius = 0.005;
  Rods rods;
  rods.add(straight({0.0, 0.0, height + radius}, {reach, 0.0, radius}, 4), radius,
           solid_round_section({2e11, 8e10, 7800.0}, radius));
  double weight = 0.0;
  double moment = 0.0;  // of weight about the pin
  for (std::size_t i = 0; i < rods.positions.size(); ++i) {
    weight += standard_gravity * rods.masses[i];
    moment += standard_gravity * rods.masses[i] * rods.positions[i].x();
  }
  Effects effects = elastic(standard_gravity);
  effects.push_back(hold(rods, {pin(0, rods.positions.front())}));
  Stepper stepper(rods, std::move(effects), StepperOptions{},
                  contacts_with_moving({going(HalfSpaceShape{}, Vector3d::Zero(), {0.5, 0.0, 0.0})},
                                       coefficient));
  for (int i = 0; i < 240; ++i) {
    stepper.step(1.0 / 240.0);
    ASSERT_EQ(stepper.report().unbalanced, 0U) << "step " << i;
  }
  const RodForces forces = stepper.forces();
  ASSERT_EQ(forces.contacts.size(), 1U);
  const double pressing = forces.contacts[0].normal_force.z();
  const double expected = moment / (reach + coefficient * height);
  EXPECT_NEAR(pressing, expected, 0.02 * expected);
  EXPECT_NEAR(forces.contacts[0].friction_force.x(), coefficient * pressing, 0.02 * pressing);
  EXPECT_GT(weight, 2.0 * pressing);
}

}  // namespace
}  // namespace fiber::test
