// Cables that lie along each other: the nearest points of parallel edges jump, the forces do not.

#include <gtest/gtest.h>

#include <algorithm>

#include "fiber_proximity/sim/effects.hpp"
#include "test/sim/random_rods.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

constexpr double laid_radius = 0.004;

/// One cable lies in the hollow between two others, its nodes beside or between theirs.
class ParallelLay : public testing::TestWithParam<double> {};

TEST_P(ParallelLay, ComesToRestInBalance) {
  constexpr double length = 0.3;
  constexpr int segments = 30;
  const double shift = GetParam() * length / segments;
  Rods rods;
  const double up = laid_radius * (1.0 + std::sqrt(3.0));
  for (const Vector3d& start :
       {Vector3d(0.0, -laid_radius, laid_radius), Vector3d(0.0, laid_radius, laid_radius),
        Vector3d(shift, 0.0, up)}) {
    rods.add(
        straight(start + Vector3d(0.0, 0.0, 1e-4), start + Vector3d(length, 0.0, 1e-4), segments),
        laid_radius, rubber(laid_radius));
  }
  Effects all = elastic(standard_gravity);
  all.push_back(std::make_unique<Damping>(0.01));
  StepperOptions options;
  options.threads = 1;
  Stepper stepper(rods, std::move(all), options,
                  contacts_with(environment_of(HalfSpaceShape{}), 0.5));
  for (int i = 0; i < 240; ++i) {
    stepper.step(1.0 / 240.0);
    ASSERT_EQ(stepper.report().unbalanced, 0U)
        << "step " << i << ", residual " << stepper.report().worst.residual;
    ASSERT_LE(stepper.report().worst.residual, options.residual);
  }
  EXPECT_EQ(stepper.report().coupled_rods, 3U);
  // The lower ones carry the upper one: half of its weight each, aslant.
  double carried = 0.0;
  for (const RodForces::ContactForce& contact : stepper.forces().contacts) {
    if (contact.other_rod != RodForces::ContactForce::obstacle &&
        (contact.rod == 2 || contact.other_rod == 2)) {
      const Vector3d force = contact.normal_force + contact.friction_force;
      carried += (contact.rod == 2 ? 1.0 : -1.0) * force.z();
    }
  }
  double weight = 0.0;
  for (std::uint32_t i = rods.first(2); i < rods.end(2); ++i) {
    weight += rods.masses[i] * standard_gravity;
  }
  EXPECT_NEAR(carried, weight, 0.02 * weight);
  // Where they touch, or as much further apart as their barriers reach.
  const double height = stepper.rods().positions[rods.first(2) + segments / 2].z();
  EXPECT_GE(height, up);
  EXPECT_LE(height, 1.05 * up);
}

INSTANTIATE_TEST_SUITE_P(Shifts, ParallelLay, testing::Values(0.0, 0.25, 0.5));

}  // namespace
}  // namespace fiber::test
