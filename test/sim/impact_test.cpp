// What falls on a table, slides into one or hits another rod: rebound, Coulomb's cone, momentum and
// energy of impacts, whatever the step.

#include "src/sim/contact/impact.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "test/support/random.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

constexpr double impact_radius = 0.005;

std::unique_ptr<Contacts> table_with(double restitution, std::shared_ptr<Friction> friction) {
  EnvironmentContact::Options options;
  options.restitution = restitution;
  std::vector<std::unique_ptr<ContactSource>> sources;
  sources.push_back(
      std::make_unique<EnvironmentContact>(environment_of(HalfSpaceShape{}), options));
  return std::make_unique<Contacts>(std::move(sources), std::move(friction));
}

/// A level rod at a height above where it touches the table [m].
Rods level_rod(const char* material, double height) {
  Rods rods;
  const double z = height + impact_radius;
  rods.add(straight({0.0, 0.0, z}, {0.0, 0.2, z}, 10), impact_radius,
           solid_round_section(material_preset(material), impact_radius));
  return rods;
}

double mean_height(const Rods& rods) {
  double sum = 0.0;
  for (const Vector3d& position : rods.positions) {
    sum += position.z();
  }
  return sum / static_cast<double>(rods.positions.size()) - impact_radius;
}

struct Drop {
  const char* material;
  Integrator integrator;
};

std::ostream& operator<<(std::ostream& out, const Drop& drop) {
  return out << drop.material
             << (drop.integrator == Integrator::BDF2 ? ", BDF2" : ", implicit Euler");
}

class DropOf : public testing::TestWithParam<Drop> {};

/// The highest point after the first impact, by energy: the square of the rebound's speed.
/// A rod falls on its first node while its last one leaves the table already, faster than it
/// should.
TEST(Impact, NeverPulls) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {1, 0, 0}, 1), 0.01, rubber(0.01));
  rods.velocities = {{0, 0, -1}, {0, 0, 3}};
  std::vector<Impact> impacts;
  for (const double end : {0.0, 1.0}) {
    Impact impact{};
    impact.points = {0, 0, end, 0, ContactPoints::no_edge, 0.0};
    impact.normal = Vector3d::UnitZ();
    impact.has_begun = true;
    impact.separation = 0.2;
    impacts.push_back(impact);
  }
  resolve(rods, 0.3, impacts);
  EXPECT_NEAR(rods.velocities[0].z(), 0.2, 1e-6);
  EXPECT_NEAR(rods.velocities[1].z(), 3.0, 1e-12);
  EXPECT_GT(impacts[0].pressure, 0.0);
  EXPECT_EQ(impacts[1].pressure, 0.0);
}

TEST_P(DropOf, ReboundsByItsRestitutionAndNeverHigherThanItFell) {
  for (const double height : {0.05, 0.3, 1.0}) {
    for (const double restitution : {0.0, 0.2, 0.7}) {
      for (const int substeps : {4, 16, 64}) {
        SCOPED_TRACE(testing::Message() << height << " m, restitution " << restitution << ", "
                                        << substeps << " substeps");
        const double step = 1.0 / (60.0 * substeps);
        StepperOptions options;
        options.integrator = GetParam().integrator;
        Stepper stepper(level_rod(GetParam().material, height), elastic(standard_gravity), options,
                        table_with(restitution, nullptr));
        const double falls = std::sqrt(2.0 * height / standard_gravity);
        double highest = 0.0;
        bool has_hit = false;
        for (double time = 0.0; time < falls * (1.1 + std::max(0.3, 1.2 * restitution));
             time += step) {
          stepper.step(step);
          has_hit |= stepper.report().impacts > 0;
          highest = has_hit ? std::max(highest, mean_height(stepper.rods())) : highest;
        }
        EXPECT_TRUE(has_hit);
        EXPECT_LE(highest, height);
        // The first step of the way back is not yet at its end, and the way up is of first order.
        const double first_order = GetParam().integrator == Integrator::BDF2 ? 0.5 : 1.0;
        // A rod that should not part is pushed up by what the barrier holds of the impact.
        const double allowed =
            (restitution == 0.0 ? 0.16 : 0.05) + first_order * restitution * step / falls;
        EXPECT_NEAR(std::sqrt(std::max(0.0, highest) / height), restitution, allowed);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Materials, DropOf,
                         testing::Values(Drop{"silicone_tube", Integrator::IMPLICIT_EULER},
                                         Drop{"power_cable", Integrator::BDF2},
                                         Drop{"rope", Integrator::IMPLICIT_EULER},
                                         Drop{"hair", Integrator::BDF2},
                                         Drop{"silicone_tube", Integrator::BDF2}));

/// However short the steps, the energy of all there is never rises with implicit Euler.
TEST(Impact, OfARodOnATableNeverAddsEnergy) {
  for (const double restitution : {0.0, 0.5, 1.0}) {
    for (const int substeps : {1, 4, 64, 256}) {
      SCOPED_TRACE(testing::Message() << restitution << ", " << substeps << " substeps");
      const double step = 1.0 / (60.0 * substeps);
      Rods rods;  // so tilted that one end hits first
      rods.add(straight({0.0, 0.0, 0.2}, {0.0, 0.2, 0.23}, 10), impact_radius,
               solid_round_section(material_preset("silicone_tube"), impact_radius));
      Stepper stepper(rods, elastic(standard_gravity), StepperOptions{},
                      table_with(restitution, nullptr));
      stepper.step(step);
      const double first = stepper.energy();
      double before = first;
      std::uint32_t impacts = 0;
      for (int i = 1; i < 60 * substeps / 2; ++i) {
        stepper.step(step);
        const double now = stepper.energy();
        ASSERT_LE(now, before + 1e-6 * std::abs(first)) << "step " << i;
        before = now;
        impacts += stepper.report().impacts;
      }
      EXPECT_GT(impacts, 0U);
    }
  }
}

/// A rod that slides into a table: friction's impulse is that of the force which presses.
TEST(Impact, ItsFrictionIsCoulombs) {
  constexpr double coefficient = 0.1;
  for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
    for (const double step : {1.0 / 60.0, 1.0 / 240.0, 1e-3, 1.0 / 4000.0, 1.0 / 16000.0}) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(integrator) << ", " << step << " s");
      Rods rods = level_rod("silicone_tube", 0.02);
      std::fill(rods.velocities.begin(), rods.velocities.end(), Vector3d(0.0, 2.0, -2.0));
      const Vector3d before = momentum_of(rods);
      StepperOptions options;
      options.integrator = integrator;
      Stepper stepper(rods, elastic(), options,
                      table_with(0.2, std::make_shared<Friction>(Friction::Options{coefficient})));
      std::uint32_t impacts = 0;
      for (double time = 0.0; time < 0.05; time += step) {
        stepper.step(step);
        impacts += stepper.report().impacts;
      }
      const Vector3d impulse = momentum_of(stepper.rods()) - before;
      EXPECT_GT(impacts, 0U);
      EXPECT_GT(impulse.z(), 0.99 * -before.z());
      EXPECT_LE(-impulse.y(), 1.02 * coefficient * impulse.z());
      EXPECT_GE(-impulse.y(), 0.98 * coefficient * impulse.z());
    }
  }
}

/// Two free rods that cross and collide, with friction.
TEST(Impact, OfFreeRodsKeepsTheirMomentum) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  for (int round = 0; round < 10; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    Rods rods;
    const Vector3d along = 0.1 * random.direction();
    const Vector3d across = along.unitOrthogonal();
    const Vector3d other = 0.1 * along.normalized().cross(across);
    const Vector3d apart = 0.03 * across;
    const RodSection section = solid_round_section(material_preset("silicone_tube"), impact_radius);
    rods.add(straight(-along, along, 10), impact_radius, section);
    rods.add(straight(apart - other, apart + other, 7), impact_radius, section);
    for (std::uint32_t i = rods.first(1); i < rods.end(1); ++i) {
      rods.velocities[i] = -2.0 * across + 0.5 * random.direction();
    }
    for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
      StepperOptions options;
      options.integrator = integrator;
      options.residual = 1e-9;
      Stepper stepper(rods, elastic(), options, contacts_with(nullptr, 0.3));
      const Vector3d momentum = momentum_of(rods);
      std::uint32_t impacts = 0;
      for (int i = 0; i < 24; ++i) {
        stepper.step(1e-3);
        impacts += stepper.report().impacts;
        ASSERT_LE((momentum_of(stepper.rods()) - momentum).norm(), 1e-6 * momentum.norm()) << i;
      }
      EXPECT_GT(impacts, 0U);
    }
  }
}

}  // namespace
}  // namespace fiber::test
