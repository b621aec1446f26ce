// Free rods conserve momentum, angular momentum and energy; and they do so the same
// wherever they are.

#include <gtest/gtest.h>

#include "fiber_proximity/sim/effects.hpp"
#include "test/sim/effect_derivatives.hpp"
#include "test/sim/random_rods.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

Vector3d momentum(const Rods& rods) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < rods.positions.size(); ++i) {
    sum += rods.masses[i] * rods.velocities[i];
  }
  return sum;
}

Vector3d angular_momentum(const Rods& rods) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < rods.positions.size(); ++i) {
    sum += rods.masses[i] * rods.positions[i].cross(rods.velocities[i]);
  }
  return sum;
}

double total_energy(const Rods& rods) {
  return kinetic_energy(rods) + energy_of(Stretch(), rods) + energy_of(Bend(), rods);
}

/// Rods on the move, bent, stretched and compressed.
Rods moving_rods(Random& random) {
  Rods rods = random_rods(random);
  displace(rods, random, 0.03);
  give_velocities(rods, random, 1.0);
  return rods;
}

/// Holds as long as steps converge: a fold of a twisted rod may have no equilibrium.
TEST(Conservation, MomentumIsKept) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  int balanced = 0;
  for (int round = 0; round < 20; ++round) {
    Rods rods = moving_rods(random);
    Effects all = effects(std::make_unique<Stretch>(), std::make_unique<Bend>(),
                          std::make_unique<Damping>(0.01));
    if (round % 2 == 0) {
      all.push_back(std::make_unique<Twist>(rods));
      displace(rods, random, 0.0, 1.0);
    }
    StepperOptions options;
    options.integrator = static_cast<Integrator>(random.integer(0, 1));
    const Vector3d before = momentum(rods);
    Stepper stepper(rods, std::move(all), options);
    for (int i = 0; i < 50; ++i) {
      stepper.step(0.01);
      if (stepper.report().unbalanced > 0) {
        break;
      }
      ++balanced;
      ASSERT_LE((momentum(stepper.rods()) - before).norm(), 1e-11) << "round " << round;
    }
  }
  expect_enough(balanced, 950);
}

/// Half the step, a quarter of the error.
TEST(Conservation, BDF2KeepsAngularMomentumAndEnergyToTheSecondOrder) {
  SCOPED_TRACE(seed_message());
  Random random(2);
  for (int round = 0; round < 10; ++round) {
    SCOPED_TRACE(round);
    const Rods rods = moving_rods(random);
    const auto after = [&rods](double step) {
      Stepper stepper(rods, effects(std::make_unique<Stretch>(), std::make_unique<Bend>()),
                      precise(Integrator::BDF2));
      while (stepper.time() < 0.5 - 0.5 * step) {
        stepper.step(step);
      }
      return stepper.rods();
    };
    const Vector3d before = angular_momentum(rods);
    const Rods coarse = after(0.002);
    const Rods fine = after(0.001);
    const double error = (angular_momentum(fine) - before).norm();
    double scale = 0.0;  // of angular momenta that may balance each other
    for (std::size_t i = 0; i < rods.masses.size(); ++i) {
      scale += rods.masses[i] * rods.positions[i].norm() * rods.velocities[i].norm();
    }
    EXPECT_LE(error, 1e-3 * scale);
    EXPECT_LE(error, 0.5 * (angular_momentum(coarse) - before).norm() + 1e-5 * scale);
    EXPECT_NEAR(total_energy(fine), total_energy(rods), 0.05 * total_energy(rods));
  }
}

TEST(Conservation, ImplicitEulerGainsNoEnergy) {
  SCOPED_TRACE(seed_message());
  Random random(4);
  for (int round = 0; round < 40; ++round) {
    Effects all = effects(std::make_unique<Stretch>(), std::make_unique<Bend>());
    if (round % 2 == 0) {
      all.push_back(std::make_unique<Damping>(0.1));
    }
    const double step = std::pow(10.0, random.uniform(-3.0, -1.0));
    Stepper stepper(moving_rods(random), std::move(all), precise());
    const double first = total_energy(stepper.rods());
    for (int i = 0; i < 200; ++i) {
      const Rods before = stepper.rods();
      stepper.step(step);
      const Rods& after = stepper.rods();
      // Not to move at all would give the incremental potential the energy there was: this bounds
      // it whatever the rods do. The energy alone falls for certain only where it is convex.
      double change = 0.0;
      for (std::size_t node = 0; node < after.masses.size(); ++node) {
        change += 0.5 * after.masses[node] *
                  (after.velocities[node] - before.velocities[node]).squaredNorm();
      }
      ASSERT_LE(total_energy(after) - kinetic_energy(after) + change,
                total_energy(before) * (1.0 + 1e-9))
          << "step " << i << " of " << step << " s, round " << round;
      ASSERT_LE(total_energy(after), first * (1.0 + 1e-3)) << "step " << i << ", round " << round;
    }
  }
}

/// Rods as a rigid motion has moved them.
Rods moved(Rods rods, const Eigen::Isometry3d& motion) {
  for (Vector3d& position : rods.positions) {
    position = motion * position;
  }
  for (auto* vectors : {&rods.velocities, &rods.directors, &rods.start_tangents}) {
    for (Vector3d& vector : *vectors) {
      vector = motion.linear() * vector;
    }
  }
  return rods;
}

Eigen::Isometry3d random_motion(Random& random) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.rotate(Eigen::AngleAxisd(random.uniform(0.0, M_PI), random.direction()));
  motion.pretranslate(random.in_cube(3.0));
  return motion;
}

TEST(Conservation, EnergiesAreTheSameEverywhere) {
  SCOPED_TRACE(seed_message());
  Random random(5);
  for (int round = 0; round < 100; ++round) {
    Rods rods = random_rods(random);
    const Twist twist(rods);
    displace(rods, random, 0.05, 1.0);
    const Rods elsewhere = moved(rods, random_motion(random));
    EXPECT_NEAR(energy_of(Stretch(), rods), energy_of(Stretch(), elsewhere), 1e-12);
    EXPECT_NEAR(energy_of(Bend(), rods), energy_of(Bend(), elsewhere), 1e-12);
    EXPECT_NEAR(energy_of(twist, rods), energy_of(twist, elsewhere), 1e-10);
  }
}

/// Moved or turned about a line across it, a rod meets no internal friction.
TEST(Conservation, RigidMotionIsNotDamped) {
  SCOPED_TRACE(seed_message());
  Random random(6);
  for (int round = 0; round < 100; ++round) {
    // Plane rods that turn about the plane's normal, and translation in any direction.
    Rods rods = random_rods(random);
    for (Vector3d& position : rods.positions) {
      position.z() = 0.0;
    }
    Damping damping(0.1);
    damping.begin_step(rods, {0.0, 0.01});
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    motion.rotate(Eigen::AngleAxisd(random.uniform(0.0, 1.0), Vector3d::UnitZ()));
    motion.pretranslate(random.in_cube());
    rods = moved(rods, motion);
    ASSERT_LE(energy_of(damping, rods), 1e-20) << "round " << round;
  }
}

}  // namespace
}  // namespace fiber::test
