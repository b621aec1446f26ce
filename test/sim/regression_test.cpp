// Problems that users of other simulators have reported.

#include <gtest/gtest.h>

#include <algorithm>

#include "fiber_proximity/sim/effects.hpp"
#include "test/sim/random_rods.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

constexpr double regression_step = 1.0 / 240.0;

double largest_difference(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, (a[i] - b[i]).norm());
  }
  return largest;
}

/// A stiff cable of 5 mm that lies on a table for a minute gains nothing
/// (github.com/newton-physics/newton, issue 3125).
TEST(Regression, AStiffCableAtRestGainsNothing) {
  constexpr double radius = 0.0025;
  Rods rods;
  rods.add(straight({-0.25, 0.0, radius}, {0.25, 0.0, radius}, 50), radius,
           solid_round_section({1e10, 4e9, 2000.0}, radius));
  StepperOptions options;
  options.threads = 1;
  Stepper stepper(rods, elastic(standard_gravity), options,
                  contacts_with(environment_of(HalfSpaceShape{}), 0.5));
  while (stepper.time() < 1.0) {
    stepper.step(regression_step);
  }
  const std::vector<Vector3d> settled = stepper.rods().positions;
  const double energy = stepper.energy();
  double fastest = 0.0;
  while (stepper.time() < 61.0) {
    stepper.step(regression_step);
    for (const Vector3d& velocity : stepper.rods().velocities) {
      fastest = std::max(fastest, velocity.norm());
    }
  }
  EXPECT_LE(fastest, 1e-4);
  EXPECT_LE(largest_difference(stepper.rods().positions, settled), 1e-5);
  EXPECT_LE(stepper.energy(), energy * (1.0 + 1e-6));
  // It is not for want of motion in the program that it lies.
  double carried = 0.0;
  for (const RodForces::ContactForce& contact : stepper.forces().contacts) {
    carried += contact.normal_force.z();
  }
  double weight = 0.0;
  for (const double mass : rods.masses) {
    weight += mass * standard_gravity;
  }
  EXPECT_NEAR(carried, weight, 0.01 * weight);
}

/// Damping does not change the shape in which a cable comes to rest
/// (github.com/newton-physics/newton, issue 2557).
TEST(Regression, DampingDoesNotChangeAStaticShape) {
  constexpr double radius = 0.005;
  Rods rods;
  rods.add(straight(Vector3d::Zero(), {0.6, 0.0, 0.0}, 20), radius, rubber(radius));
  const auto hanging = [&](double relaxation_time) {
    Effects all = elastic(standard_gravity);
    if (relaxation_time > 0.0) {
      all.push_back(std::make_unique<Damping>(relaxation_time));
    }
    all.push_back(hold(rods, {clamp(0, {Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY()}),
                              pin(20, {0.4, 0.0, 0.0})}));
    Stepper stepper(rods, std::move(all), precise());
    settle(stepper);
    return stepper.rods().positions;
  };
  const std::vector<Vector3d> undamped = hanging(0.0);
  EXPECT_GT(largest_difference(undamped, rods.positions), 0.05) << "it hangs";
  for (const double relaxation_time : {0.01, 0.1, 1.0}) {
    EXPECT_LE(largest_difference(hanging(relaxation_time), undamped), 1e-6) << relaxation_time;
  }
}

}  // namespace
}  // namespace fiber::test
