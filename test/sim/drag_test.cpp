#include <gtest/gtest.h>

#include <cmath>

#include "fiber_proximity/sim/effects.hpp"
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

}  // namespace
}  // namespace fiber::test
