// Where cross-sections have a rotation of their own, friction acts at the surface: rods roll down
// slopes and between others, and what collides keeps its angular momentum, spins included.

#include "validation/sim/rolling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "test/support/random.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

std::ostream& print_integrator(std::ostream& out, Integrator integrator) {
  return out << (integrator == Integrator::BDF2 ? "BDF2" : "implicit Euler");
}

struct Slope {
  double angle;  // [°]
  double radius;
  Integrator integrator;
};

std::ostream& operator<<(std::ostream& out, const Slope& slope) {
  out << slope.angle << " degrees, radius " << slope.radius << " m, ";
  return print_integrator(out, slope.integrator);
}

class RollingOn : public testing::TestWithParam<Slope> {};

/// A solid round rod has the inertia m r² / 2.
TEST_P(RollingOn, ARodRollsWithTwoThirdsOfGravityAlongTheSlope) {
  const auto& [degrees, radius, integrator] = GetParam();
  const double angle = degrees * M_PI / 180.0;
  const RodOnSlope rod(angle, radius, std::tan(angle), integrator);
  rod.run(0.25);
  const double before = rod.speed();
  rod.run(0.5);
  const double expected = 2.0 / 3.0 * standard_gravity * std::sin(angle);
  EXPECT_NEAR((rod.speed() - before) / 0.5, expected, 0.01 * expected);
  EXPECT_NEAR(rod.mean_spin() * radius, rod.speed(), 0.01 * rod.speed());
}

/// Rolling takes a friction of a third of the weight along the slope.
TEST_P(RollingOn, ARodWithLittleFrictionSlidesAndRolls) {
  const auto& [degrees, radius, integrator] = GetParam();
  const double angle = degrees * M_PI / 180.0;
  const double coefficient = 0.15 * std::tan(angle);
  const RodOnSlope rod(angle, radius, coefficient, integrator);
  rod.run(0.25);
  const double speed = rod.speed();
  const double spin = rod.mean_spin();
  rod.run(0.5);
  const double expected = 0.85 * standard_gravity * std::sin(angle);
  EXPECT_NEAR((rod.speed() - speed) / 0.5, expected, 0.01 * expected);
  const double expected_turn = 2.0 * coefficient * standard_gravity * std::cos(angle) / radius;
  EXPECT_NEAR((rod.mean_spin() - spin) / 0.5, expected_turn, 0.01 * expected_turn);
}

INSTANTIATE_TEST_SUITE_P(Slopes, RollingOn,
                         testing::Values(Slope{5.0, 0.005, Integrator::IMPLICIT_EULER},
                                         Slope{10.0, 0.005, Integrator::BDF2},
                                         Slope{20.0, 0.01, Integrator::IMPLICIT_EULER},
                                         Slope{20.0, 0.005, Integrator::BDF2},
                                         Slope{35.0, 0.01, Integrator::BDF2},
                                         Slope{35.0, 0.005, Integrator::IMPLICIT_EULER}));

/// A hold at an end that moves with a velocity and does not turn.
Attachment::Hold moving_clamp(std::uint32_t rod, std::uint32_t node, const Vector3d& from,
                              const Vector3d& velocity) {
  return {rod, node, Attachment::Kind::CLAMP, [from, velocity](double time) {
            const Vector3d tangent = Vector3d::UnitY();
            return Placement{from + time * velocity, tangent, tangent.unitOrthogonal()};
          }};
}

/// A cable between two fingers, of which the upper one moves: it goes half as far.
TEST(Rolling, ACableTwistedBetweenFingersTravels) {
  constexpr double thick = 0.01;
  constexpr double thin = 0.004;
  constexpr double speed = 0.05;
  const Vector3d apart(0.0, 0.0, 0.995 * (thick + thin));
  for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
    SCOPED_TRACE(static_cast<int>(integrator));
    const Vector3d half(0.0, 0.04, 0.0);
    Rods rods;
    rods.add(straight(-1.5 * half, 1.5 * half, 10), thin, rubber(thin));
    rods.add(straight(-apart - half, -apart + half, 7), thick, rubber(thick));
    rods.add(straight(apart - half, apart + half, 7), thick, rubber(thick));
    Effects all = elastic();
    all.push_back(std::make_unique<Twist>(rods));
    const Vector3d velocity(speed, 0.0, 0.0);
    all.push_back(hold(rods, {moving_clamp(1, 0, -apart - half, Vector3d::Zero()),
                              moving_clamp(1, 7, -apart + half, Vector3d::Zero()),
                              moving_clamp(2, 0, apart - half, velocity),
                              moving_clamp(2, 7, apart + half, velocity)}));
    StepperOptions options;
    options.integrator = integrator;
    Stepper stepper(rods, std::move(all), options, contacts_with(nullptr, 0.5));
    const auto place = [&stepper] { return stepper.rods().positions[5].x(); };
    const auto turn = [&stepper] { return stepper.rods().angles[4]; };
    const auto run = [&stepper](int steps) {
      for (int i = 0; i < steps; ++i) {
        stepper.step(1.0 / 240.0);
      }
    };
    run(12);
    const double first_place = place();
    const double first_turn = turn();
    run(12);
    const double way = 0.5 * speed * 12.0 / 240.0;
    EXPECT_NEAR(place() - first_place, way, 0.05 * way);
    EXPECT_NEAR((turn() - first_turn) * thin, way, 0.05 * way);
  }
}

/// Angular momentum that a step of implicit Euler has added: by the changes of velocities where the
/// nodes end, and by those of spins, each about the mean direction of its edge in the step. The
/// rest of its change is the integrator's own, the step times the cross product of momenta.
Vector3d added_angular_momentum(const Rods& before, const Rods& after) {
  Vector3d sum = Vector3d::Zero();
  for (std::uint32_t rod = 0; rod < after.count(); ++rod) {
    for (std::uint32_t i = after.first(rod); i < after.end(rod); ++i) {
      sum += after.masses[i] * after.positions[i].cross(after.velocities[i] - before.velocities[i]);
      if (i + 1 < after.end(rod)) {
        const Vector3d first = (before.positions[i + 1] - before.positions[i]).normalized();
        const Vector3d last = (after.positions[i + 1] - after.positions[i]).normalized();
        sum += after.section_inertia(rod, i) * (after.spins[i] - before.spins[i]) * (first + last) /
               (1.0 + first.dot(last));
      }
    }
  }
  return sum;
}

Vector3d angular_momentum_with_spins(const Rods& rods) {
  Vector3d sum = Vector3d::Zero();
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      sum += rods.masses[i] * rods.positions[i].cross(rods.velocities[i]);
      if (i + 1 < rods.end(rod)) {
        sum += rods.section_inertia(rod, i) * rods.spins[i] *
               (rods.positions[i + 1] - rods.positions[i]).normalized();
      }
    }
  }
  return sum;
}

/// What all nodes could have of it, if they did not balance each other.
double angular_scale(const Rods& rods) {
  double sum = 0.0;
  for (std::size_t i = 0; i < rods.positions.size(); ++i) {
    sum += rods.masses[i] * rods.positions[i].norm() * rods.velocities[i].norm();
  }
  return sum;
}

constexpr double free_radius = 0.005;

/// Two rods that cross at any angle and fly at each other, spinning.
Rods colliding_rods(Random& random) {
  const Vector3d along = 0.1 * random.direction();
  const Vector3d across = along.unitOrthogonal();
  const Vector3d other = 0.1 * random.direction();
  const Vector3d apart = 0.02 * along.cross(other).normalized();
  const RodSection section = solid_round_section(material_preset("silicone_tube"), free_radius);
  Rods rods;
  rods.add(straight(-along, along, 10), free_radius, section);
  rods.add(straight(apart - other, apart + other, 7), 0.7 * free_radius, section);
  for (std::uint32_t i = rods.first(1); i < rods.end(1); ++i) {
    rods.velocities[i] = -2.0 * apart.normalized() + 0.5 * across;
  }
  return rods;
}

TEST(Rolling, ForcesOfContactKeepAngularMomentumWithTheSpins) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  for (int round = 0; round < 10; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    Rods rods = colliding_rods(random);
    Effects all = elastic();
    all.push_back(std::make_unique<Twist>(rods));
    for (double& spin : rods.spins) {
      spin = 20.0;
    }
    StepperOptions options;
    options.residual = 1e-9;
    Stepper stepper(rods, std::move(all), options, contacts_with(nullptr, 0.5));
    const double scale = angular_scale(rods);
    std::uint32_t impacts = 0;
    double turned = 0.0;
    for (int i = 0; i < 24; ++i) {
      const Rods before = stepper.rods();
      stepper.step(1e-3);
      impacts += stepper.report().impacts;
      ASSERT_LE(added_angular_momentum(before, stepper.rods()).norm(), 1e-9 * scale) << i;
      ASSERT_LE((momentum_of(stepper.rods()) - momentum_of(rods)).norm(), 1e-6) << i;
      turned += std::abs(stepper.rods().spins[5] - before.spins[5]);
    }
    EXPECT_GT(impacts, 0U);
    EXPECT_GT(turned, 1.0);
  }
}

/// Two parallel rods that graze each other: velocities stay in a plane. The step of an impact is of
/// implicit Euler, whose own error is of the order of the step.
TEST(Rolling, BDF2KeepsAngularMomentumOfRodsThatCollideToTheOrderOfTheStep) {
  for (const double step : {1e-3, 1e-4}) {
    for (const double height : {0.018, 0.019, 0.020, 0.021}) {
      SCOPED_TRACE(testing::Message() << step << " s, from " << height << " m");
      Rods rods;
      const RodSection section = solid_round_section(material_preset("silicone_tube"), free_radius);
      const Vector3d half(0.0, 0.1, 0.0);
      const Vector3d start(0.005, 0.003, height);
      rods.add(straight(-half, half, 10), free_radius, section);
      rods.add(straight(start - half, start + half, 10), free_radius, section);
      for (std::uint32_t i = rods.first(1); i < rods.end(1); ++i) {
        rods.velocities[i] = Vector3d(0.5, 0.0, -2.0);
      }
      Effects all = elastic();
      all.push_back(std::make_unique<Twist>(rods));
      StepperOptions options;
      options.integrator = Integrator::BDF2;
      options.residual = 1e-8;
      Stepper stepper(rods, std::move(all), options, contacts_with(nullptr, 0.5));
      const Vector3d before = angular_momentum_with_spins(rods);
      while (stepper.time() < 0.02) {
        stepper.step(step);
      }
      const Vector3d change = angular_momentum_with_spins(stepper.rods()) - before;
      EXPECT_LE(change.norm(), 2.0 * step * angular_scale(rods));
    }
  }
}

/// Also where most of the normal impulse of a step is taken back: of a rod that spins about itself.
TEST(Rolling, CoulombHoldsInTheStepsAfterAnImpact) {
  constexpr double coefficient = 0.3;
  for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
    for (const double step : {1.0 / 240.0, 1.0 / 960.0}) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(integrator) << " " << step);
      Rods rods;
      const RodSection thin = solid_round_section(material_preset("power_cable"), 0.004);
      const RodSection thick = solid_round_section(material_preset("power_cable"), 0.008);
      rods.add(straight({-0.25, 0.0, 0.1}, {0.25, 0.0, 0.1}, 20), 0.004, thin);
      rods.add(straight({-0.25, 0.001, 0.13}, {0.25, 0.001, 0.13}, 21), 0.008, thick);
      Effects all = effects(std::make_unique<Stretch>(), std::make_unique<Bend>(),
                            std::make_unique<Twist>(rods));
      for (std::uint32_t i = 0; i < rods.end(0); ++i) {
        rods.velocities[i] = {0.0, 0.0, 2.0};
        rods.spins[i] = 2.0;
      }
      FiberContact::Options options;
      options.restitution = 0.0;
      std::vector<std::unique_ptr<ContactSource>> sources;
      sources.push_back(std::make_unique<FiberContact>(options));
      StepperOptions stepping = precise(integrator);
      Stepper stepper(std::move(rods), std::move(all), stepping,
                      std::make_unique<Contacts>(
                          std::move(sources),
                          std::make_unique<Friction>(Friction::Options{coefficient, 1e-3})));
      double largest = 0.0;   // normal force
      std::size_t after = 0;  // contacts in steps after the impact
      for (double time = 0.0; time < 0.05; time += step) {
        stepper.step(step);
        for (const RodForces::ContactForce& force : stepper.forces().contacts) {
          const double normal = force.normal_force.norm();
          EXPECT_LE(force.friction_force.norm(), 1.02 * coefficient * normal + 1e-7 * largest)
              << stepper.time();
          after += largest > 0.0 && normal < 0.1 * largest ? 1 : 0;
          largest = std::max(largest, normal);
        }
      }
      EXPECT_GT(after, 10U);
    }
  }
}

}  // namespace
}  // namespace fiber::test
