// Energy and angular momentum without input.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "test/sim/extra_scene.hpp"
#include "test/sim/random_rods.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

double weight_times_length_of(const Rods& rods) {
  double sum = 0.0;
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    double mass = 0.0;
    double length = 0.0;
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      mass += rods.masses[i];
      length += rods.rest_lengths[i];
    }
    sum += mass * standard_gravity * length;
  }
  return sum;
}

double mean_height_of(const Rods& rods) {
  double sum = 0.0;
  for (const Vector3d& position : rods.positions) {
    sum += position.z();
  }
  return sum / static_cast<double>(rods.positions.size());
}

/// Rods that fall on a table and on each other.
Rods falling() {
  constexpr double radius = 0.004;
  Rods rods;
  for (int rod = 0; rod < 5; ++rod) {
    const double turn = 1.3 * rod;
    const Vector3d along(0.12 * std::cos(turn), 0.12 * std::sin(turn), 0.01 * rod);
    const Vector3d middle(0.01 * rod, 0.0, 0.03 + 0.03 * rod);
    rods.add(straight(middle - along, middle + along, 16), radius,
             solid_round_section(material_preset("silicone_tube"), radius));
  }
  return rods;
}

/// What there is beside rods alike that fall, and the coefficient of friction.
class EnergyOf : public testing::TestWithParam<std::tuple<Extra, double>> {};

/// But for the work of a table that moves, as the force on it tells.
TEST_P(EnergyOf, ImplicitEulerGainsNoneInAnyStepWithContacts) {
  const auto [kind, friction] = GetParam();
  const ExtraScene extra(falling(), kind, 0.19);
  const double scale = weight_times_length_of(extra.rods());
  StepperOptions options;
  options.threads = 1;
  Effects all = elastic(standard_gravity);
  extra.add_effects(all);
  Stepper stepper(extra.rods(), std::move(all), options, extra.contacts(0.0, friction),
                  extra.joints());
  constexpr double step = 1.0 / 240.0;
  stepper.step(step);
  std::size_t contacts = 0;
  double all_work = 0.0;
  int unbalanced = 0;
  for (int i = 0; i < 480; ++i) {
    const double before = stepper.energy();
    const double kinetic = kinetic_energy(stepper.rods());
    stepper.step(step);
    const RodForces forces = stepper.forces();
    double work = 0.0;
    for (const RodForces::ObstacleForce& force : forces.obstacles) {
      work -= step * force.force.dot(extra.table_velocity());
    }
    all_work += work;
    unbalanced += stepper.report().unbalanced > 0 ? 1 : 0;
    ASSERT_LE(stepper.energy(), before + work + 1e-6 * (kinetic + scale)) << "step " << i;
    ASSERT_LE(stepper.report().energy_gain, 1e-6 * (kinetic + scale)) << "step " << i;
    contacts = std::max(contacts, forces.contacts.size());
  }
  // What pulls at rods that are wedged has a step end by its iterations: it gains none either.
  EXPECT_LE(unbalanced, kind == Extra::LOADS ? 1 : 0);
  EXPECT_GT(contacts, 20U);
  const double table = extra.table_at(stepper.time()).translation().z();
  EXPECT_LT(mean_height_of(stepper.rods()) - table, 0.5 * mean_height_of(extra.rods()))
      << "they have fallen";
  EXPECT_EQ(all_work > 0.0, kind == Extra::LIFT);
}

INSTANTIATE_TEST_SUITE_P(Scenes, EnergyOf,
                         testing::Combine(testing::Values(Extra::NONE, Extra::LOADS,
                                                          Extra::SECTIONS, Extra::BALL, Extra::WELD,
                                                          Extra::CLOSED, Extra::LIFT),
                                          testing::Values(0.0, 0.3)),
                         [](const auto& scene) {
                           return name_of(std::get<0>(scene.param)) +
                                  (std::get<1>(scene.param) > 0.0 ? "_friction" : "");
                         });

/// A soft cable that swings from one end.
TEST(Energy, BDF2LosesAtMostOnePercentOfAPendulumIn60Seconds) {
  constexpr double radius = 0.005;
  Rods rods;
  rods.add(straight(Vector3d::Zero(), {0.35, 0.0, -0.35}, 10), radius,
           solid_round_section({1e9, 4e8, 1000.0}, radius));
  Effects all = elastic(standard_gravity);
  all.push_back(hold(rods, {pin(0, Vector3d::Zero())}));
  StepperOptions options = precise(Integrator::BDF2);
  options.residual = 1e-7;
  Stepper stepper(rods, std::move(all), options);
  constexpr double step = 1.0 / 500.0;
  stepper.step(step);
  const auto height = [&] { return stepper.rods().positions[5].z(); };
  const double first = stepper.energy();
  const double lowest = -weight_times_length_of(rods) * 0.5 * std::sqrt(0.5) * std::sqrt(2.0);
  double fastest = 0.0;
  while (stepper.time() < 60.0) {
    stepper.step(step);
    fastest = std::max(fastest, std::abs(stepper.rods().velocities[10].norm()));
    ASSERT_LE(height(), 0.0);
  }
  EXPECT_NEAR(stepper.energy(), first, 0.01 * (first - lowest));
  EXPECT_GT(fastest, 1.5);
}

/// Across its axis at 10 rad/s: so fast that centrifugal forces stretch it a little.
TEST(Energy, BDF2KeepsTheAngularMomentumOfASpinningRod) {
  constexpr double radius = 0.005;
  constexpr double spin = 10.0;
  for (const bool has_contacts : {false, true}) {
    Rods rods;
    rods.add(straight({-0.5, 0.0, 0.0}, {0.5, 0.0, 0.0}, 20), radius, rubber(radius));
    for (std::size_t i = 0; i < rods.positions.size(); ++i) {
      rods.velocities[i] = spin * Vector3d::UnitZ().cross(rods.positions[i]);
    }
    const auto momentum = [](const Rods& r) {
      Vector3d sum = Vector3d::Zero();
      for (std::size_t i = 0; i < r.positions.size(); ++i) {
        sum += r.masses[i] * r.positions[i].cross(r.velocities[i]);
      }
      return sum.z();
    };
    StepperOptions options;
    options.integrator = Integrator::BDF2;
    options.threads = 1;
    Stepper stepper(rods, elastic(), options, has_contacts ? contacts_with(nullptr, 0.3) : nullptr);
    double turned = 0.0;  // [rad]
    while (stepper.time() < 10.0) {
      const Vector3d before = stepper.rods().positions[20] - stepper.rods().positions[0];
      stepper.step(1.0 / 240.0);
      const Vector3d after = stepper.rods().positions[20] - stepper.rods().positions[0];
      turned += std::atan2(before.cross(after).z(), before.dot(after));
    }
    EXPECT_NEAR(momentum(stepper.rods()), momentum(rods), 0.01 * momentum(rods));
    EXPECT_NEAR(turned, 100.0, 5.0);
  }
}

}  // namespace
}  // namespace fiber::test
