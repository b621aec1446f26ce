// What falls on a table, slides into one or hits another rod: rebound, Coulomb's cone, momentum and
// energy of impacts, whatever the step.

#include "src/sim/contact/impact.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "test/environment/random_shapes.hpp"
#include "test/sim/extra_scene.hpp"
#include "test/support/random.hpp"
#include "validation/sim/impacts.hpp"

namespace fiber::test {
namespace {

std::string name_of(const Drop& drop) {
  return drop.material + (drop.integrator == Integrator::BDF2 ? "_bdf2" : "_implicit_euler") +
         (drop.velocity.isZero() ? "" : "_on_a_table_that_moves");
}

class DropOf : public testing::TestWithParam<Drop> {};

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

/// What a contact has given is taken back down to the speed with which the step began, no further,
/// and no more than it has given.
TEST(Impact, TakesBackNoMoreThanHasBeenGiven) {
  const auto speed_after = [](double speed, double returnable) {
    Rods rods;
    rods.add(straight({0, 0, 0}, {1, 0, 0}, 1), 0.01, rubber(0.01));
    rods.velocities.assign(2, speed * Vector3d::UnitZ());
    Impact impact{};
    impact.points = {0, 0, 0.0, 0, ContactPoints::no_edge, 0.0};
    impact.normal = Vector3d::UnitZ();
    impact.returnable = returnable * rods.masses[0];
    impact.max_separation = 0.5;
    std::vector<Impact> impacts{impact};
    resolve(rods, 0.0, impacts);
    return rods.velocities[0].z();
  };
  EXPECT_NEAR(speed_after(0.8, 10.0), 0.5, 1e-6);
  EXPECT_NEAR(speed_after(0.8, 0.1), 0.7, 1e-6);
  EXPECT_NEAR(speed_after(0.3, 10.0), 0.3, 1e-12);
  EXPECT_NEAR(speed_after(-0.3, 10.0), -0.3, 1e-12);
}

/// A stiff rod of one edge, level, whose middle falls on the top of something: it rebounds by its
/// restitution, never higher than it fell, and nothing passes.
TEST(Impact, OnEachKindOfSolidReboundsByItsRestitution) {
  constexpr double size = 0.1;
  constexpr double half = 0.01;
  const std::vector<std::pair<std::string, Shape>> solids{
      {"box", BoxShape{Vector3d::Constant(size)}},
      {"sphere", SphereShape{0.5 * size}},
      {"cylinder", CylinderShape{0.5 * size, size}},
      {"capsule", CapsuleShape{0.3 * size, 0.4 * size}},
      {"cone", ConeShape{0.5 * size, size}},
      {"half space", HalfSpaceShape{Vector3d::UnitZ(), 0.5 * size}},
      {"plane", PlaneShape{Vector3d::UnitZ(), 0.5 * size}},
      {"mesh", box_mesh(Vector3d::Constant(size), 3)}};
  for (const auto& [name, solid] : solids) {
    for (const double restitution : {0.0, 0.5}) {
      for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
        SCOPED_TRACE(testing::Message() << name << ", restitution " << restitution
                                        << ", integrator " << static_cast<int>(integrator));
        constexpr double height = 0.1;
        constexpr double step = 1.0 / 960.0;
        const double touching = 0.5 * size + 1.05 * impact_radius;
        Rods rods;
        const double z = touching + height;
        const double beside = name == "cone" ? 0.0 : 0.003;  // of the middle; of a tip it slips
        rods.add(straight({beside, -half, z}, {beside, half, z}, 1), impact_radius,
                 solid_round_section(material_preset("power_cable"), impact_radius));
        EnvironmentContact::Options contact;
        contact.restitution = restitution;
        std::vector<std::unique_ptr<ContactSource>> sources;
        sources.push_back(std::make_unique<EnvironmentContact>(environment_of(solid), contact));
        StepperOptions options;
        options.integrator = integrator;
        Stepper stepper(rods, elastic(standard_gravity), options,
                        std::make_unique<Contacts>(std::move(sources), nullptr));
        double highest = -1.0;
        double lowest = z;
        bool has_hit = false;
        const double falls = std::sqrt(2.0 * height / standard_gravity);
        for (double time = 0.0; time < falls * (1.05 + restitution); time += step) {
          stepper.step(step);
          const double now = 0.5 * (stepper.rods().positions[0] + stepper.rods().positions[1]).z();
          has_hit |= stepper.report().impacts > 0;
          highest = has_hit ? std::max(highest, now - touching) : highest;
          lowest = std::min(lowest, now);
        }
        EXPECT_TRUE(has_hit);
        EXPECT_GT(lowest, 0.5 * size + 0.95 * impact_radius);
        EXPECT_NEAR(std::sqrt(std::max(0.0, highest) / height), restitution, 0.05);
      }
    }
  }
}

/// The highest point above the table after the first impact, by energy: the square of the rebound's
/// speed.
TEST_P(DropOf, ReboundsByItsRestitutionAndNeverHigherThanItFell) {
  for (const double height : {0.05, 0.3, 1.0}) {
    for (const double restitution : {0.0, 0.2, 0.7}) {
      for (const int substeps : {4, 16, 64}) {
        SCOPED_TRACE(testing::Message() << height << " m, restitution " << restitution << ", "
                                        << substeps << " substeps");
        Drop drop = GetParam();
        drop.height = height;
        drop.restitution = restitution;
        drop.step = 1.0 / (60.0 * substeps);
        const double highest = simulated_rebound(drop);
        EXPECT_GE(highest, -impact_radius) << "it hits";
        EXPECT_LE(highest, height);
        // The first step of the way back is not yet at its end, and the way up is of first order.
        const double first_order = drop.integrator == Integrator::BDF2 ? 0.5 : 1.0;
        const double allowed = 0.05 + first_order * restitution * drop.step / drop.fall();
        EXPECT_NEAR(std::sqrt(std::max(0.0, highest) / height), restitution, allowed);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Materials, DropOf,
    testing::Values(Drop{"silicone_tube", Integrator::IMPLICIT_EULER},
                    Drop{"power_cable", Integrator::BDF2}, Drop{"rope", Integrator::IMPLICIT_EULER},
                    Drop{"hair", Integrator::BDF2}, Drop{"silicone_tube", Integrator::BDF2},
                    Drop{"rope", Integrator::BDF2}, Drop{"hair", Integrator::IMPLICIT_EULER},
                    Drop{"power_cable", Integrator::IMPLICIT_EULER},
                    Drop{"silicone_tube", Integrator::IMPLICIT_EULER, {0.3, 0.2, 0.5}},
                    Drop{"power_cable", Integrator::BDF2, {0.0, 0.0, -0.4}}),
    [](const auto& drop) { return name_of(drop.param); });

/// However short the steps, the energy of all there is never rises with implicit Euler, but for the
/// work of a table that moves, as the force on it tells.
TEST(Impact, OfARodOnATableNeverAddsEnergy) {
  for (const double restitution : {0.0, 0.5, 1.0}) {
    for (const int substeps : {1, 4, 64, 256}) {
      for (const Vector3d& velocity : {Vector3d(0.0, 0.0, 0.0), Vector3d(0.1, 0.0, 0.4)}) {
        SCOPED_TRACE(testing::Message()
                     << restitution << ", " << substeps << " substeps, " << velocity.z() << " m/s");
        const double step = 1.0 / (60.0 * substeps);
        Rods rods;  // so tilted that one end hits first
        rods.add(straight({0.0, 0.0, 0.2}, {0.0, 0.2, 0.23}, 10), impact_radius,
                 solid_round_section(material_preset("silicone_tube"), impact_radius));
        Stepper stepper(rods, elastic(standard_gravity), StepperOptions{},
                        table_with(restitution, nullptr, velocity));
        stepper.step(step);
        const double first = stepper.energy();
        double before = first;
        std::uint32_t impacts = 0;
        double all_work = 0.0;
        for (int i = 1; i < 60 * substeps / 2; ++i) {
          stepper.step(step);
          const double now = stepper.energy();
          double work = 0.0;
          for (const RodForces::ObstacleForce& force : stepper.forces().obstacles) {
            work -= step * force.force.dot(velocity);
          }
          ASSERT_LE(now, before + work + 1e-6 * std::abs(first)) << "step " << i;
          before = now;
          all_work += work;
          impacts += stepper.report().impacts;
        }
        EXPECT_GT(impacts, 0U);
        EXPECT_EQ(all_work > 0.0, !velocity.isZero());
      }
    }
  }
}

/// A rod that slides into a table: friction's impulse is that of the force which presses.
TEST(Impact, ItsFrictionIsCoulombs) {
  constexpr double coefficient = 0.1;
  for (const char* const material : {"silicone_tube", "power_cable", "rope", "hair"}) {
    for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
      for (const double step : {1.0 / 60.0, 1.0 / 240.0, 1e-3, 1.0 / 4000.0, 1.0 / 16000.0}) {
        for (const double restitution : {0.0, 0.2}) {
          SCOPED_TRACE(testing::Message() << material << ", " << static_cast<int>(integrator)
                                          << ", " << step << " s, restitution " << restitution);
          const Deflection found =
              simulated_deflection(integrator, step, restitution, coefficient, material);
          EXPECT_TRUE(found.has_hit);
          EXPECT_GT(found.across, 0.99 * found.approach);
          EXPECT_LE(found.along, 1.02 * coefficient * found.across);
          EXPECT_GE(found.along, 0.98 * coefficient * found.across);
        }
      }
    }
  }
}

/// What a free rod hits: another one across it, from this point along this way, or what that is a
/// part of.
/// @returns null for no joints
std::unique_ptr<Joints> add_target(Rods& rods, Extra extra, const Vector3d& middle,
                                   const Vector3d& half, const Vector3d& up) {
  const RodSection section = rods.sections[0];
  std::unique_ptr<Joints> joints;
  if (extra == Extra::BALL || extra == Extra::WELD) {
    // It is hit at the joint.
    rods.add(straight(middle - half, middle, 4), impact_radius, section);
    rods.add(straight(middle, middle + half, 3), impact_radius, section);
    rods.add(straight(middle, middle + 0.5 * up, 3), impact_radius, section);
    joints = std::make_unique<Joints>(Joints::Options{});
    joints->add(rods, {extra == Extra::BALL ? Joints::Kind::BALL : Joints::Kind::WELD,
                       {{1, 4}, {2, 0}, {3, 0}}});
  } else if (extra == Extra::CLOSED) {
    // Where it begins and ends.
    std::vector<Vector3d> points;
    const double radius = half.norm();
    for (int i = 0; i <= 24; ++i) {
      const double angle = 2.0 * M_PI * (i % 24) / 24.0;
      points.emplace_back(middle + radius * (1.0 - std::cos(angle)) * up.normalized() +
                          std::sin(angle) * half);
    }
    rods.add(points, impact_radius, section);
    joints = std::make_unique<Joints>(Joints::Options{});
    joints->close(rods, 1);
  } else {
    rods.add(straight(middle - half, middle + half, 7), impact_radius, section);
    if (extra == Extra::SECTIONS) {
      add_plug(rods, 1, 3);
    }
  }
  return joints;
}

class ImpactOf : public testing::TestWithParam<Extra> {};

/// Free rods that cross and collide, with friction.
TEST_P(ImpactOf, FreeRodsKeepsMomentum) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  for (int round = 0; round < 10; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    Rods rods;
    const Vector3d along = 0.1 * random.direction();
    const Vector3d across = along.unitOrthogonal();
    const Vector3d other = 0.1 * along.normalized().cross(across);
    const RodSection section = solid_round_section(material_preset("silicone_tube"), impact_radius);
    rods.add(straight(-along, along, 10), impact_radius, section);
    const auto target = [&](Rods& all) {
      return add_target(all, GetParam(), 0.03 * across, other, 0.1 * across);
    };
    const auto joints = target(rods);
    const Vector3d velocity = -2.0 * across;
    for (std::uint32_t i = rods.first(1); i < rods.positions.size(); ++i) {
      rods.velocities[i] = velocity + 0.5 * random.direction();
    }
    if (joints != nullptr) {
      joints->unite(rods);
    }
    for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
      StepperOptions options;
      options.integrator = integrator;
      options.residual = 1e-9;
      Rods again;
      again.add(straight(-along, along, 10), impact_radius, section);
      Effects effects = elastic();
      if (GetParam() == Extra::STRIPS) {
        for (auto& effect : make_strips(rods)) {
          effects.push_back(std::move(effect));
        }
      }
      Stepper stepper(rods, std::move(effects), options, contacts_with(nullptr, 0.3),
                      target(again));
      const Vector3d momentum = momentum_of(rods);
      std::uint32_t impacts = 0;
      for (int i = 0; i < 24; ++i) {
        const double before = i == 0 ? 0.0 : stepper.energy();
        stepper.step(1e-3);
        impacts += stepper.report().impacts;
        ASSERT_LE((momentum_of(stepper.rods()) - momentum).norm(), 1e-6 * momentum.norm()) << i;
        if (i > 0 && integrator == Integrator::IMPLICIT_EULER) {
          ASSERT_LE(stepper.energy(), before * (1.0 + 1e-6)) << i;
        }
      }
      EXPECT_GT(impacts, 0U);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ImpactOf,
                         testing::Values(Extra::NONE, Extra::SECTIONS, Extra::BALL, Extra::WELD,
                                         Extra::CLOSED, Extra::STRIPS),
                         [](const auto& extra) { return name_of(extra.param); });

}  // namespace
}  // namespace fiber::test
