// What acts on rods from outside.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fiber_proximity/sim/effects.hpp"
#include "test/support/error_of.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

TEST(Drag, ARodFallsAsFastAsItsWidthInTheAirAllows) {
  constexpr double gravity = 9.81;           // [m/s²]
  constexpr double radius = 0.005;           // [m]
  constexpr double mass_per_length = 0.001;  // [kg/m]
  Rods rods;
  rods.add(straight(Vector3d::Zero(), Vector3d::UnitX(), 10), radius,
           {1e4, 1e-3, 0.0, mass_per_length, 0.0});
  Drag::Options air;
  air.fluid_density = 1.2;
  air.across = 1.1;
  Stepper stepper(rods, effects(std::make_unique<Gravity>(Vector3d(0.0, 0.0, -gravity)),
                                std::make_unique<Stretch>(), std::make_unique<Drag>(air)));
  for (int i = 0; i < 300; ++i) {
    stepper.step(0.01);
  }
  const double width = 2.0 * radius;
  const double speed =
      std::sqrt(mass_per_length * gravity / (0.5 * air.fluid_density * air.across * width));
  for (const Vector3d& velocity : stepper.rods().velocities) {
    EXPECT_NEAR(velocity.z(), -speed, 1e-3 * speed);
  }
}

TEST(GravityInTime, IsThatOfTheEndOfTheStep) {
  Rods rods;
  rods.add(straight(Vector3d::Zero(), Vector3d::UnitX(), 10), 0.01, {1e4, 1.0, 0.8, 1.0, 1e-4});
  const TimeTable<Vector3d> table(
      {{0.0, {0.0, 0.0, 0.0}}, {0.2, {0.0, 0.0, -4.0}}, {0.4, {3.0, 0.0, 0.0}}}, true);
  Stepper stepper(rods,
                  effects(std::make_unique<GravityInTime>(table), std::make_unique<Stretch>()),
                  precise());
  Vector3d velocity = Vector3d::Zero();
  for (int i = 0; i < 100; ++i) {
    stepper.step(0.01);
    velocity += 0.01 * table.at(stepper.time());
    ASSERT_LE((stepper.rods().velocities[3] - velocity).norm(), 1e-10) << "step " << i;
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(error_of([&] {
              GravityInTime(TimeTable<Vector3d>({{0.0, {0, 0, 0}}, {1.0, {nan, 0, 0}}}, false));
            }),
            "gravity: the acceleration is (nan, 0.000000, 0.000000) m/s^2, it must be finite");
}

}  // namespace
}  // namespace fiber::test
