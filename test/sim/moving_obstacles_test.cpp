// Objects that move as they are told push rods, and feel them.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "test/environment/random_shapes.hpp"
#include "test/support/random.hpp"
#include "validation/sim/impacts.hpp"
#include "validation/sim/moving_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double pushed_radius = 0.002;

Rods pushed_rod(std::uint32_t edges = 20) {
  Rods rods;
  rods.add(straight({0.0, -0.2, 0.0}, {0.0, 0.2, 0.0}, static_cast<int>(edges)), pushed_radius,
           rubber(pushed_radius));
  return rods;
}

StepperOptions fully_balanced() {
  StepperOptions options;
  options.residual = 1e-7;
  options.max_iterations = 1000;
  options.threads = 1;
  return options;
}

const BoxShape pusher{Vector3d(0.1, 0.3, 0.1)};

TEST(MovingObstacles, AMovingBoxTakesARodAlong) {
  Stepper stepper(pushed_rod(), elastic(), fully_balanced(),
                  contacts_with_moving({going(pusher, {-0.06, 0.0, 0.0}, {2.0, 0.0, 0.0})}));
  for (int i = 0; i < 60; ++i) {
    stepper.step(1.0 / 240.0);
  }
  const double face = -0.06 + 0.05 + 2.0 * stepper.time();
  for (std::size_t i = 3; i < 18; ++i) {
    EXPECT_GT(stepper.rods().positions[i].x(), face + 0.94 * pushed_radius);
  }
  EXPECT_GT(momentum_of(stepper.rods()).x(), 0.0);
}

/// Of both friction and normal forces, and of the impact.
TEST(MovingObstacles, WhatABoxFeelsIsTheMomentumOfTheRods) {
  for (const auto integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
    const Push found = simulated_push(integrator);
    EXPECT_LT(found.largest_error, 1e-4);
    EXPECT_GT(found.momentum.norm(), 0.0);
    const double allowed = integrator == Integrator::IMPLICIT_EULER ? 1e-4 : 0.1;
    EXPECT_LT((found.momentum - found.impulse).norm(), allowed * found.momentum.norm());
  }
}

/// By a step of implicit Euler forces act where it ends.
TEST(MovingObstacles, TheMomentOnABoxTurnsTheRodsTheOtherWay) {
  Stepper stepper(pushed_rod(), elastic(), fully_balanced(),
                  contacts_with_moving({going(pusher, {-0.06, 0.1, 0.01}, {2.0, 0.0, 0.3})}, 0.3));
  const double step = 1.0 / 240.0;
  double largest = 0.0;
  for (int i = 0; i < 48; ++i) {
    const std::vector<Vector3d> before = stepper.rods().velocities;
    stepper.step(step);
    const Rods& rods = stepper.rods();
    const RodForces::ObstacleForce force = stepper.forces().obstacles.at(0);
    EXPECT_EQ(force.point, stepper.moving_obstacles()->poses()[0].translation());
    Vector3d change = Vector3d::Zero();
    for (std::size_t node = 0; node < rods.positions.size(); ++node) {
      change +=
          rods.masses[node] * rods.positions[node].cross(rods.velocities[node] - before[node]);
    }
    largest = std::max(largest, change.norm());
    EXPECT_LT((change + step * (force.moment + force.point.cross(force.force))).norm(),
              1e-4 * largest)
        << i;
  }
  EXPECT_GT(largest, 0.0);
}

/// A rod that flies at an object, and an object that flies at a rod, are the same but for where one
/// looks from.
TEST(MovingObstacles, MotionIsRelative) {
  for (const std::optional<double> friction :
       {std::optional<double>(), std::optional<double>(0.4)}) {
    const Vector3d velocity(1.5, 0.4, 0.2);
    Rods flying = pushed_rod();
    for (Vector3d& each : flying.velocities) {
      each = -velocity;
    }
    Stepper still(flying, elastic(), fully_balanced(),
                  contacts_with(environment_of(pusher, at_place({-0.06, 0.02, 0.0})), friction));
    Stepper moving(pushed_rod(), elastic(), fully_balanced(),
                   contacts_with_moving({going(pusher, {-0.06, 0.02, 0.0}, velocity)}, friction));
    std::uint32_t impacts = 0;
    for (int i = 0; i < 60; ++i) {
      still.step(1.0 / 240.0);
      moving.step(1.0 / 240.0);
      impacts += still.report().impacts;
      EXPECT_EQ(still.report().impacts, moving.report().impacts) << i;
      for (std::size_t node = 0; node < flying.positions.size(); ++node) {
        ASSERT_LT(
            (still.rods().positions[node] + still.time() * velocity - moving.rods().positions[node])
                .norm(),
            1e-5)
            << i << ' ' << node;
      }
    }
    EXPECT_GT(impacts, 0U);
  }
}

TEST(MovingObstacles, OneThatRestsIsAsOneThatStands) {
  const auto fall = [](std::unique_ptr<Contacts> contacts) {
    Stepper stepper(pushed_rod(), elastic(standard_gravity), fully_balanced(), std::move(contacts));
    for (int i = 0; i < 60; ++i) {
      stepper.step(1.0 / 240.0);
    }
    return stepper.rods();
  };
  const Rods standing =
      fall(contacts_with(environment_of(pusher, at_place({0.0, 0.05, -0.06})), 0.3));
  const Rods resting =
      fall(contacts_with_moving({going(pusher, {0.0, 0.05, -0.06}, Vector3d::Zero())}, 0.3));
  for (std::size_t i = 0; i < standing.positions.size(); ++i) {
    EXPECT_LT((standing.positions[i] - resting.positions[i]).norm(), 1e-9);
  }
}

/// A step of any length, as nothing is elastic: energies of obstacles' work are none of the step.
TEST(MovingObstacles, TheirWorkIsNoGainOfEnergy) {
  Stepper stepper(pushed_rod(), elastic(), fully_balanced(),
                  contacts_with_moving({going(pusher, {-0.06, 0.0, 0.0}, {3.0, 0.0, 0.0})}, 0.3));
  for (int i = 0; i < 60; ++i) {
    stepper.step(1.0 / 240.0);
    EXPECT_LT(stepper.report().energy_gain, 1e-9 + 1e-6 * stepper.energy()) << i;
  }
}

/// A rod on a turntable that friction takes along, faster and faster.
TEST(MovingObstacles, FrictionHoldsWhatLiesOnWhatTurns) {
  Rods rods;
  rods.add(straight({0.1, -0.02, 1.001 * pushed_radius}, {0.1, 0.02, 1.001 * pushed_radius}, 4),
           pushed_radius, rubber(pushed_radius));
  const auto angle = [](double time) { return 0.5 * time * time; };
  const auto table = moving("table", CylinderShape{0.2, 0.02}, [&](double time) {
    return Isometry3d(Eigen::AngleAxisd(angle(time), Vector3d::UnitZ()) *
                      Eigen::Translation3d(0.0, 0.0, -0.01));
  });
  Stepper stepper(rods, elastic(standard_gravity), fully_balanced(),
                  contacts_with_moving({table}, 0.8));
  for (int i = 0; i < 480; ++i) {
    stepper.step(1.0 / 240.0);
  }
  const Eigen::AngleAxisd turn(angle(stepper.time()), Vector3d::UnitZ());
  for (std::size_t i = 0; i < rods.positions.size(); ++i) {
    const Vector3d expected = turn * rods.positions[i];
    EXPECT_LT((stepper.rods().positions[i] - expected).head<2>().norm(), 0.002) << i;
  }
}

/// Two jaws that would close on less than the rod's thickness.
TEST(MovingObstacles, AGripperThatCannotCloseStaysBehind) {
  Rods rods = pushed_rod();
  const auto jaw = [](const char* name, double side) {
    return moving(name, BoxShape{Vector3d(0.02, 0.05, 0.02)}, [side](double time) {
      const double gap = std::max(0.5 * pushed_radius, 0.01 - 0.02 * time);
      return at_place({side * (0.01 + gap), 0.0, 0.0});
    });
  };
  Stepper stepper(rods, elastic(), StepperOptions{},
                  contacts_with_moving({jaw("left", -1.0), jaw("right", 1.0)}, 0.5));
  for (int i = 0; i < 240; ++i) {
    stepper.step(1.0 / 240.0);
    ASSERT_TRUE(all_finite(stepper.rods())) << i;
    const double left = stepper.moving_obstacles()->poses()[0].translation().x() + 0.01;
    const double right = stepper.moving_obstacles()->poses()[1].translation().x() - 0.01;
    for (const Vector3d& position : stepper.rods().positions) {
      if (std::abs(position.y()) < 0.025) {
        ASSERT_GT(position.x(), left + 0.9 * pushed_radius) << i;
        ASSERT_LT(position.x(), right - 0.9 * pushed_radius) << i;
      }
    }
  }
  const auto lag = stepper.moving_obstacles()->longest_lag(stepper.time());
  ASSERT_TRUE(lag.has_value());
  EXPECT_NEAR(lag->distance, 0.45 * pushed_radius, 0.06 * pushed_radius);
  // They press no harder the longer they try: each contact with 14 times what doubles the length.
  const double most = 15.0 * rods.sections[0].stretching_stiffness;
  const std::size_t contacts = stepper.forces().contacts.size();
  for (const RodForces::ObstacleForce& jaw_force : stepper.forces().obstacles) {
    EXPECT_GT(std::abs(jaw_force.force.x()), 0.01 * most);
    EXPECT_LT(jaw_force.force.norm(), most * static_cast<double>(contacts));
  }
}

/// Free ropes that a box hits flatly, askew, and over its edges.
TEST(MovingObstacles, DoNotStayBehindFibersThatAreFree) {
  SCOPED_TRACE(seed_message());
  Random random;
  constexpr double speed = 5.0;
  constexpr double radius = 0.004;
  const std::array<const char*, 3> materials{"power_cable", "rope", "silicone_tube"};
  for (int i = 0; i < 4 * static_cast<int>(materials.size()); ++i) {
    const char* const material = materials[static_cast<std::size_t>(i) % materials.size()];
    for (const int edges : {40, 100}) {
      SCOPED_TRACE(std::string(material) + " of " + std::to_string(edges) + " edges, draw " +
                   std::to_string(i));
      Rods rods;
      rods.add(straight(Vector3d(0.1, -0.25, 0.0) + random.in_cube(0.02),
                        Vector3d(0.1, 0.25, 0.0) + random.in_cube(0.02), edges),
               radius, solid_round_section(material_preset(material), radius));
      StepperOptions options;
      options.threads = 1;
      Stepper stepper(rods, elastic(), options,
                      contacts_with_moving({going(BoxShape{Vector3d(0.1, 0.1, 0.3)},
                                                  {-0.02, 0.0, 0.0}, {speed, 0.0, 0.0})},
                                           0.4));
      for (int n = 0; n < 24; ++n) {
        stepper.step(1.0 / 240.0);
        EXPECT_FALSE(stepper.moving_obstacles()->longest_lag(stepper.time()).has_value()) << n;
      }
      double mass = 0.0;
      for (const double each : rods.masses) {
        mass += each;
      }
      const double along = momentum_of(stepper.rods()).x() / mass;
      EXPECT_GT(along, 0.2 * speed);
      EXPECT_LT(along, 1.5 * speed);
    }
  }
}

TEST(MovingObstacles, AStateIsTakenWithWhereTheyAre) {
  const auto make = [] {
    return std::make_unique<Stepper>(
        pushed_rod(), elastic(), fully_balanced(),
        contacts_with_moving({going(pusher, {-0.06, 0.0, 0.0}, {2.0, 0.0, 0.0})}, 0.3));
  };
  const auto first = make();
  for (int i = 0; i < 12; ++i) {
    first->step(1.0 / 240.0);
  }
  const auto second = make();
  second->take_state(*first);
  for (int i = 0; i < 12; ++i) {
    first->step(1.0 / 240.0);
    second->step(1.0 / 240.0);
  }
  EXPECT_EQ(first->rods().positions, second->rods().positions);
  EXPECT_EQ(first->moving_obstacles()->poses()[0].translation(),
            second->moving_obstacles()->poses()[0].translation());
}

}  // namespace
}  // namespace fiber::test
