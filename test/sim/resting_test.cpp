// Rods that fall, rest, collide, or meet nothing.

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "fiber_proximity/sim/contact_stiffness.hpp"
#include "sim/contact_scenes.hpp"
#include "sim/random_rods.hpp"
#include "support/random.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

constexpr double radius = 0.005;
constexpr double step = 1.0 / 240.0;

Rods one_rod(double height, int edges = 10) {
  Rods rods;
  rods.add(straight({-0.1, 0.0, height}, {0.1, 0.0, height}, edges), radius, rubber(radius));
  return rods;
}

double weight_of(const Rods& rods) {
  double mass = 0.0;
  for (const double m : rods.masses) {
    mass += m;
  }
  return mass * standard_gravity;
}

struct Simulation {
  Simulation(Rods rods, const std::shared_ptr<const Environment>& environment,
             double gravity = standard_gravity, const StepperOptions& options = {}) {
    auto all = contacts_with(environment, 0.3);
    contacts = all.get();
    stepper = std::make_unique<Stepper>(std::move(rods), elastic(gravity), options, std::move(all));
  }

  void run(int steps) {
    for (int i = 0; i < steps; ++i) {
      stepper->step(step);
    }
  }

  Contacts* contacts = nullptr;
  std::unique_ptr<Stepper> stepper;
};

TEST(Resting, ARodSinksIntoATableByItsWeightOverTheStiffness) {
  Simulation simulation(one_rod(radius), environment_of(HalfSpaceShape{}));
  simulation.run(480);
  const Rods& rods = simulation.stepper->rods();
  double carried = 0.0;
  for (const ContactPoint& point : simulation.contacts->points()) {
    carried += point.stiffness * point.depth;
  }
  EXPECT_NEAR(carried, weight_of(rods), 1e-3 * weight_of(rods));
  const double stiffness = material_contact_stiffness(rods.sections[0], radius);
  double mean = 0.0;
  for (const Vector3d& position : rods.positions) {
    mean += position.z() / static_cast<double>(rods.positions.size());
    EXPECT_LT(std::abs(position.z() - radius), 2.0 * rods.masses[5] * standard_gravity / stiffness);
  }
  const double depth = weight_of(rods) / (stiffness * static_cast<double>(rods.positions.size()));
  EXPECT_NEAR(radius - mean, depth, 0.01 * depth);
  EXPECT_LT(kinetic_energy(rods), 1e-12);
}

TEST(Resting, RodsAcrossEachOtherCarryEachOther) {
  Rods rods;
  for (const double x : {-0.05, 0.05}) {
    rods.add(straight({x, -0.1, radius}, {x, 0.1, radius}, 10), radius, rubber(radius));
  }
  const double upper = 3.0 * radius;
  rods.add(straight({-0.1, 0.003, upper}, {0.1, 0.003, upper}, 11), radius, rubber(radius));
  Simulation simulation(rods, environment_of(HalfSpaceShape{}));
  simulation.run(480);
  const double weight = weight_of(rods);
  double on_table = 0.0;
  double on_rods = 0.0;
  for (const ContactPoint& point : simulation.contacts->points()) {
    (point.is_obstacle() ? on_table : on_rods) += point.stiffness * point.depth;
  }
  EXPECT_NEAR(on_table, weight, 0.01 * weight);
  EXPECT_NEAR(on_rods, weight / 3.0, 0.01 * weight);
  EXPECT_LT(kinetic_energy(simulation.stepper->rods()), 1e-9);
}

TEST(Resting, ADroppedRodDoesNotBounceHigherThanItFell) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  for (int repeat = 0; repeat < 5; ++repeat) {
    const Vector3d along = 0.1 * random.direction();
    Rods rods;
    rods.add(straight(Vector3d(0.0, 0.0, 0.3) - along, Vector3d(0.0, 0.0, 0.3) + along, 8), radius,
             rubber(radius));
    Simulation simulation(rods, environment_of(HalfSpaceShape{}));
    const auto energy = [&] {
      const Rods& now = simulation.stepper->rods();
      double potential = 0.0;
      for (std::size_t i = 0; i < now.positions.size(); ++i) {
        potential += now.masses[i] * standard_gravity * now.positions[i].z();
      }
      for (const ContactPoint& point : simulation.contacts->points()) {
        potential += 0.5 * point.stiffness * point.depth * point.depth;
      }
      return potential + kinetic_energy(now) + elastic_energy_of(now);
    };
    const double first = energy();
    for (int i = 0; i < 480; ++i) {
      simulation.run(1);
      ASSERT_LE(energy(), first * (1.0 + 1e-6)) << "step " << i;
    }
    EXPECT_LT(energy(), 0.5 * first);
  }
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
    for (std::size_t node = 0; node < rods.positions.size(); ++node) {
      ASSERT_LE((free.rods().positions[node] - with.rods().positions[node]).norm(), 1e-7)
          << "step " << i << ", node " << node;
    }
  }
}

Rods small_pile() {
  Rods rods;
  for (int rod = 0; rod < 5; ++rod) {
    const Vector3d along(rod % 2 == 0 ? 0.1 : 0.02, rod % 2 == 0 ? -0.01 * rod : 0.1, 0.0);
    const Vector3d middle(0.0, 0.0, 0.01 + 0.011 * rod);
    rods.add(straight(middle - along, middle + along, 12), radius, rubber(radius));
  }
  return rods;
}

TEST(Determinism, ContactsAreTheSameBitForBitForAnyThreadCount) {
  const tbb::global_control more_than_cores(tbb::global_control::max_allowed_parallelism, 4);
  std::vector<Vector3d> expected;
  for (const std::uint32_t threads : {1U, 2U, 4U, 4U}) {
    StepperOptions options;
    options.threads = threads;
    Simulation simulation(small_pile(), environment_of(HalfSpaceShape{}), standard_gravity,
                          options);
    simulation.run(60);
    EXPECT_GT(simulation.contacts->points().size(), 10U);
    const std::vector<Vector3d>& positions = simulation.stepper->rods().positions;
    if (expected.empty()) {
      expected = positions;
    }
    EXPECT_EQ(positions, expected) << threads << " threads";
  }
}

TEST(Collision, OfFreeRodsKeepsTheirMomentum) {
  Rods rods;
  rods.add(straight({-0.1, 0.0, 0.0}, {0.1, 0.0, 0.0}, 9), radius, rubber(radius));
  rods.add(straight({0.02, -0.1, 0.02}, {0.01, 0.1, 0.02}, 9), radius, rubber(radius));
  for (std::uint32_t node = rods.first(1); node < rods.end(1); ++node) {
    rods.velocities[node] = Vector3d(0.2, 0.0, -1.0);
  }
  const Vector3d momentum = momentum_of(rods);
  const double energy = kinetic_energy(rods);
  Simulation simulation(rods, nullptr, 0.0);
  std::size_t most = 0;
  for (int i = 0; i < 48; ++i) {
    simulation.run(1);
    most = std::max(most, simulation.contacts->points().size());
    EXPECT_LE(kinetic_energy(simulation.stepper->rods()), energy);
  }
  const Rods& after = simulation.stepper->rods();
  EXPECT_GT(most, 0U);
  EXPECT_GT(std::abs(after.velocities[0].z()), 0.01);
  EXPECT_LE((momentum_of(after) - momentum).norm(), 0.01 * momentum.norm());
}

}  // namespace
}  // namespace fiber::test
