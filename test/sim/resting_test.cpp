// Rods that fall, rest, collide, or meet nothing.

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "src/sim/contact/barrier.hpp"
#include "src/sim/contact/edge_contact.hpp"
#include "test/sim/random_rods.hpp"
#include "test/support/random.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

constexpr double resting_radius = 0.005;
constexpr double resting_step = 1.0 / 240.0;

Rods one_rod(double height, int edges = 10) {
  Rods rods;
  rods.add(straight({-0.1, 0.0, height}, {0.1, 0.0, height}, edges), resting_radius,
           rubber(resting_radius));
  return rods;
}

double weight_of(const Rods& rods) {
  double mass = 0.0;
  for (const double m : rods.masses) {
    mass += m;
  }
  return mass * standard_gravity;
}

std::unique_ptr<Stepper> simulation(Rods rods,
                                    const std::shared_ptr<const Environment>& environment,
                                    double gravity = standard_gravity,
                                    const StepperOptions& options = {}) {
  return std::make_unique<Stepper>(std::move(rods), elastic(gravity), options,
                                   contacts_with(environment, 0.3));
}

void run(Stepper& stepper, int steps) {
  for (int i = 0; i < steps; ++i) {
    stepper.step(resting_step);
  }
}

/// The upward force of obstacles, or rods [N].
double carried(const Stepper& stepper, bool by_obstacles) {
  double sum = 0.0;
  for (const RodForces::ContactForce& contact : stepper.forces().contacts) {
    if ((contact.other_rod == RodForces::ContactForce::obstacle) == by_obstacles) {
      sum += std::abs(contact.normal_force.z());
    }
  }
  return sum;
}

TEST(Resting, ARodLiesWhereTheBarrierBearsItsWeight) {
  const auto stepper = simulation(one_rod(1.02 * resting_radius), environment_of(HalfSpaceShape{}));
  run(*stepper, 480);
  const Rods& rods = stepper->rods();
  const double weight = weight_of(rods);
  EXPECT_NEAR(carried(*stepper, true), weight, 1e-3 * weight);
  const Barrier barrier =
      Barrier::around(resting_radius, material_contact_stiffness(rods.sections[0], resting_radius));
  double borne = 0.0;
  for (const Vector3d& position : rods.positions) {
    ASSERT_GT(position.z(), 0.95 * resting_radius);
    ASSERT_LT(position.z(), 1.05 * resting_radius);
    borne -= barrier.slope(position.z());
  }
  EXPECT_NEAR(borne, weight, 1e-3 * weight);
  EXPECT_LT(kinetic_energy(rods), 1e-12);
}

TEST(Resting, RodsAcrossEachOtherCarryEachOther) {
  Rods rods;
  for (const double x : {-0.05, 0.05}) {
    rods.add(straight({x, -0.1, resting_radius}, {x, 0.1, resting_radius}, 10), resting_radius,
             rubber(resting_radius));
  }
  const double upper = 3.0 * resting_radius;
  rods.add(straight({-0.1, 0.003, upper}, {0.1, 0.003, upper}, 11), resting_radius,
           rubber(resting_radius));
  const auto stepper = simulation(rods, environment_of(HalfSpaceShape{}));
  run(*stepper, 480);
  const double weight = weight_of(rods);
  EXPECT_NEAR(carried(*stepper, true), weight, 0.01 * weight);
  EXPECT_NEAR(carried(*stepper, false), weight / 3.0, 0.01 * weight);
  EXPECT_LT(kinetic_energy(stepper->rods()), 1e-9);
}

TEST(Resting, ADroppedRodDoesNotBounceHigherThanItFell) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  for (int repeat = 0; repeat < 5; ++repeat) {
    const Vector3d along = 0.1 * random.direction();
    Rods rods;
    rods.add(straight(Vector3d(0.0, 0.0, 0.3) - along, Vector3d(0.0, 0.0, 0.3) + along, 8),
             resting_radius, rubber(resting_radius));
    const auto stepper = simulation(rods, environment_of(HalfSpaceShape{}));
    const double first = 0.3 * weight_of(rods);  // above the table
    run(*stepper, 1);
    EXPECT_NEAR(stepper->energy(), first, 1e-3 * first);
    for (int i = 0; i < 480; ++i) {
      run(*stepper, 1);
      ASSERT_LE(stepper->energy(), first * (1.0 + 1e-6)) << "step " << i;
    }
    EXPECT_LT(stepper->energy(), 0.5 * first);
  }
}

TEST(Resting, APileStaysAtRestForTenThousandSteps) {
  Rods rods;
  for (int rod = 0; rod < 3; ++rod) {
    const double turn = rod * M_PI / 3.0;
    const Vector3d along(0.1 * std::cos(turn), 0.1 * std::sin(turn), 0.0);
    const Vector3d middle(0.0, 0.0, 0.01 + 0.012 * rod);
    rods.add(straight(middle - along, middle + along, 6), 0.005, rubber(0.005));
  }
  Stepper stepper(rods, elastic(standard_gravity), StepperOptions{},
                  contacts_with(environment_of(HalfSpaceShape{}), 0.3));
  double highest = 0.0;
  for (int i = 0; i < 10000; ++i) {
    stepper.step(1.0 / 240.0);
    ASSERT_TRUE(all_finite(stepper.rods())) << "step " << i;
    if (i >= 1000) {
      highest = std::max(highest, kinetic_energy(stepper.rods()));
    }
  }
  EXPECT_LT(highest, 1e-6);
}

constexpr double far = 1.0;  // [m] nothing that goes so far is held

/// The farthest that a node of some rods goes until then [m], or more than `far` as soon as one
/// does.
double farthest_until(Stepper& stepper, double end, double step) {
  const std::vector<Vector3d> before = stepper.rods().positions;
  double farthest = 0.0;
  while (stepper.time() < end && farthest <= far) {
    stepper.step(step);
    for (std::size_t i = 0; i < before.size(); ++i) {
      farthest = std::max(farthest, (stepper.rods().positions[i] - before[i]).norm());
    }
  }
  return farthest;
}

/// The same in a time, after one in which they settle.
double farthest_in(Stepper& stepper, double settling, double time, double step) {
  const double way = farthest_until(stepper, settling, step);
  return way > far ? way : farthest_until(stepper, settling + time, step);
}

/// A rod across a slope and one along it, and three that are stacked: all loads of friction, in
/// contacts with obstacles and of rods.
TEST(Resting, WhatFrictionHoldsDoesNotCreep) {
  for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
    for (const double step : {1.0 / 60.0, 1.0 / 240.0}) {
      StepperOptions options;
      options.integrator = integrator;
      const auto simulate = [&](const Rods& rods, const Vector3d& gravity, double coefficient) {
        Effects effects = elastic(0.0);
        effects.push_back(std::make_unique<Gravity>(gravity));
        Stepper stepper(rods, std::move(effects), options,
                        contacts_with(environment_of(HalfSpaceShape{}), coefficient));
        return farthest_in(stepper, 2.0, 60.0, step);
      };
      constexpr double above = 1.05 * resting_radius;
      const Vector3d x(0.1, 0, 0);
      const Vector3d y(0, 0.1, 0);
      const Vector3d z(0, 0, above);
      Rods apart;
      apart.add(straight(z - x, z + x, 4), resting_radius, rubber(resting_radius));
      apart.add(straight(5.0 * x + z - y, 5.0 * x + z + y, 4), resting_radius,
                rubber(resting_radius));
      const double slope = 10.0 * M_PI / 180.0;
      const Vector3d down(0.0, -std::sin(slope), -std::cos(slope));
      EXPECT_LT(simulate(apart, standard_gravity * down, 0.3), 1e-7) << "the slope";
      EXPECT_GT(simulate(apart, standard_gravity * down, 0.15), far) << "too steep to rest";
      Rods stack;
      for (const double side : {-1.0, 1.0}) {
        const Vector3d middle = z + Vector3d(0.0, 1.02 * side * resting_radius, 0.0);
        stack.add(straight(middle - x, middle + x, 4), resting_radius, rubber(resting_radius));
      }
      const Vector3d upper = z + Vector3d(0.0, 0.0, 1.83 * resting_radius);
      stack.add(straight(upper - x, upper + x, 4), resting_radius, rubber(resting_radius));
      EXPECT_LT(simulate(stack, Vector3d(0, 0, -standard_gravity), 0.5), 1e-7) << "the stack";
    }
  }
}

/// A rope that hangs over a hook, one of its ends lower than the other: friction carries the
/// difference. Its ends swing out first: implicit Euler takes the sooner from that the longer its
/// steps.
TEST(Resting, ARopeOverAHookDoesNotCreep) {
  constexpr double hook_radius = 0.03;
  constexpr double axis_radius = hook_radius + 1.04 * resting_radius;
  constexpr int edges_over = 8;
  constexpr int shorter = 24;
  const auto rope_over = [&](int longer) {
    std::vector<Vector3d> points;
    const double turn = M_PI / edges_over;
    const double edge = 2.0 * axis_radius * std::tan(0.5 * turn);
    for (int i = shorter; i > 0; --i) {
      points.emplace_back(-axis_radius, 0.0, -edge * (i - 0.5));
    }
    for (int i = 0; i < edges_over; ++i) {
      const double angle = (i + 0.5) * turn;
      const double corner = axis_radius / std::cos(0.5 * turn);
      points.emplace_back(-corner * std::cos(angle), 0.0, corner * std::sin(angle));
    }
    for (int i = 1; i <= shorter + longer; ++i) {
      points.emplace_back(axis_radius, 0.0, -edge * (i - 0.5));
    }
    return points;
  };
  const Eigen::Isometry3d level(Eigen::AngleAxisd(0.5 * M_PI, Vector3d::UnitX()));
  const auto simulate = [&](int longer) {
    Rods rods;
    rods.add(rope_over(longer), resting_radius,
             solid_round_section(material_preset("rope"), resting_radius));
    Stepper stepper(rods, elastic(standard_gravity), {},
                    contacts_with(environment_of(CylinderShape{hook_radius, 1.0}, level), 0.3));
    const double way = farthest_until(stepper, 90.0, 1.0 / 60.0);
    return way > far ? way : farthest_in(stepper, 100.0, 60.0, resting_step);
  };
  EXPECT_LT(simulate(8), 1e-6);
  EXPECT_GT(simulate(60), far) << "slides off";
}

TEST(FreeFlight, IsTheSameWithContactEffects) {
  // Thin rods and long steps: from one to the next they fall further than they are thick.
  constexpr double thin = 2e-4;
  SCOPED_TRACE(seed_message());
  Random random(2);
  Rods rods;
  for (int rod = 0; rod < 3; ++rod) {
    const Vector3d start(rod, 0.0, 100.0);
    rods.add(straight(start, start + 0.2 * random.direction(), 10), thin, rubber(thin));
  }
  Stepper free(rods, elastic(standard_gravity), StepperOptions{});
  Stepper with(rods, elastic(standard_gravity), StepperOptions{},
               contacts_with(environment_of(HalfSpaceShape{}), 0.3));
  for (int i = 0; i < 60; ++i) {
    free.step(1.0 / 60.0);
    with.step(1.0 / 60.0);
    ASSERT_EQ(free.rods().positions, with.rods().positions) << "step " << i;
    ASSERT_EQ(free.rods().velocities, with.rods().velocities) << "step " << i;
  }
  EXPECT_LT(free.rods().positions[0].z(), 96.0);
}

Rods small_pile() {
  Rods rods;
  for (int rod = 0; rod < 5; ++rod) {
    const Vector3d along(rod % 2 == 0 ? 0.1 : 0.02, rod % 2 == 0 ? -0.01 * rod : 0.1, 0.0);
    const Vector3d middle(0.0, 0.0, 0.01 + 0.011 * rod);
    rods.add(straight(middle - along, middle + along, 12), resting_radius, rubber(resting_radius));
  }
  return rods;
}

TEST(Determinism, ContactsAreTheSameBitForBitForAnyThreadCount) {
  const tbb::global_control more_than_cores(tbb::global_control::max_allowed_parallelism, 4);
  std::vector<Vector3d> expected;
  for (const std::uint32_t threads : {1U, 2U, 4U, 4U}) {
    StepperOptions options;
    options.threads = threads;
    const auto stepper =
        simulation(small_pile(), environment_of(HalfSpaceShape{}), standard_gravity, options);
    run(*stepper, 60);
    EXPECT_GT(stepper->forces().contacts.size(), 10U);
    EXPECT_EQ(stepper->report().coupled_rods, 5U);
    const std::vector<Vector3d>& positions = stepper->rods().positions;
    if (expected.empty()) {
      expected = positions;
    }
    EXPECT_EQ(positions, expected) << threads << " threads";
  }
}

TEST(Collision, OfFreeRodsKeepsTheirMomentum) {
  Rods rods;
  rods.add(straight({-0.1, 0.0, 0.0}, {0.1, 0.0, 0.0}, 9), resting_radius, rubber(resting_radius));
  rods.add(straight({0.02, -0.1, 0.02}, {0.01, 0.1, 0.02}, 9), resting_radius,
           rubber(resting_radius));
  for (std::uint32_t node = rods.first(1); node < rods.end(1); ++node) {
    rods.velocities[node] = Vector3d(0.2, 0.0, -1.0);
  }
  const Vector3d momentum = momentum_of(rods);
  const double energy = kinetic_energy(rods);
  const auto stepper = simulation(rods, nullptr, 0.0);
  std::size_t most = 0;
  for (int i = 0; i < 48; ++i) {
    run(*stepper, 1);
    most = std::max(most, stepper->forces().contacts.size());
    EXPECT_LE(kinetic_energy(stepper->rods()), energy);
  }
  const Rods& after = stepper->rods();
  EXPECT_GT(most, 0U);
  EXPECT_GT(std::abs(after.velocities[0].z()), 0.01);
  EXPECT_LE((momentum_of(after) - momentum).norm(), 1e-3 * momentum.norm());
}

}  // namespace
}  // namespace fiber::test
