// Rods whose sections differ along them.

#include <gtest/gtest.h>

#include <cmath>

#include "fiber_proximity/sim/effects.hpp"
#include "fiber_proximity/sim/forces.hpp"
#include "fiber_proximity/sim/loads.hpp"
#include "test/sim/effect_derivatives.hpp"
#include "test/sim/random_rods.hpp"
#include "test/support/error_of.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

const RodSection thin{1e4, 1.0, 0.8, 1.0, 1e-4};
const RodSection thick{5e4, 7.0, 5.0, 3.0, 4e-4};
constexpr double thick_from = 0.313;
constexpr double thick_to = 0.757;

/// A rod of 1 m, thick in its middle, whose parts end inside of edges.
Rods stepped_rod(int segments = 10) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {1, 0, 0}, segments), 0.01, thin);
  rods.set_sections(0, {{{thick_from, thick_to}, thick}});
  return rods;
}

TEST(Sections, HaveTheirMassesWhereTheyAre) {
  const Rods rods = stepped_rod();
  double mass = 0.0;
  double moment = 0.0;
  double inertia = 0.0;
  for (std::uint32_t i = 0; i < rods.node_count(0); ++i) {
    mass += rods.masses[i];
    moment += rods.masses[i] * rods.positions[i].x();
    inertia += rods.section_inertia(0, i);
  }
  const double length = thick_to - thick_from;
  EXPECT_NEAR(mass, 1.0 + 2.0 * length, 1e-12);
  EXPECT_NEAR(moment, 0.5 + 2.0 * length * 0.5 * (thick_from + thick_to), 0.005);
  EXPECT_NEAR(inertia, 1e-4 + 3e-4 * length, 1e-12);
}

TEST(Sections, DerivativesAreThoseOfTheEnergy) {
  SCOPED_TRACE(seed_message());
  Random random(31);
  for (int round = 0; round < 20; ++round) {
    Rods rods;
    for (int rod = 0; rod < 3; ++rod) {
      rods.add(random_chain(random, 6, 0.3), 0.01, random_section(random));
      double length = 0.0;
      for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
        length += rods.rest_lengths[i];
      }
      if (rod != 1) {
        rods.set_sections(rod, {{{0.0, random.uniform(0.1, 0.4) * length}, random_section(random)},
                                {{0.6 * length, length}, random_section(random)}});
      }
    }
    std::vector<std::shared_ptr<Effect>> effects{
        std::make_shared<Stretch>(), std::make_shared<Bend>(), std::make_shared<Damping>(0.02)};
    if (round % 2 == 0) {
      effects.push_back(std::make_shared<Twist>(rods));
    }
    auto attachment = std::make_shared<Attachment>();
    const Vector3d along = (rods.positions[1] - rods.positions[0]).normalized();
    attachment->add(rods, clamp(0, {rods.positions[0], along,
                                    rods.directors.empty() ? along : rods.directors[0]}));
    effects.push_back(attachment);
    for (const auto& effect : effects) {
      effect->begin_step(rods, {0.0, 0.01});
    }
    displace(rods, random, 0.03, 0.5);
    for (const auto& effect : effects) {
      for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
        const Eigen::VectorXd found = derivatives_of(*effect, rods, rod).gradient;
        const Eigen::VectorXd expected = gradient_by_differences(*effect, rods, rod, 1e-6);
        ASSERT_LE((found - expected).norm(), 1e-5 * (1.0 + expected.norm())) << "round " << round;
      }
      expect_same_side_by_side(*effect, rods);
    }
  }
}

/// A rod is in series what its parts are: longer by F l / EA of each, and twisted by M l / GJ.
TEST(Sections, GiveWayInSeries) {
  Rods rods = stepped_rod();
  auto twist = std::make_unique<Twist>(rods);
  auto loads = std::make_unique<Loads>();
  Loads::Load load;
  load.node = 10;
  load.force = TimeTable<Vector3d>(Vector3d(10.0, 0.0, 0.0));
  load.torque = TimeTable<double>(0.3);
  loads->add(rods, load);
  auto clamped = hold(rods, {clamp(0, {Vector3d::Zero(), Vector3d::UnitX(), rods.directors[0]})});
  Stepper stepper(rods,
                  effects(std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(twist),
                          std::move(clamped), std::move(loads)),
                  precise());
  for (int i = 0; i < 40; ++i) {
    stepper.step(10.0);
  }
  const double length = thick_to - thick_from;
  const Rods& after = stepper.rods();
  const double longer = 10.0 * ((1.0 - length) / 1e4 + length / 5e4);
  const double from_hold = after.positions[10].x() - 1.0 - after.positions[0].x();
  EXPECT_NEAR(from_hold, longer, 1e-6 * longer);
  // The last half edge is behind its torque.
  const double twisted = 0.3 * ((0.95 - length) / 0.8 + length / 5.0);
  EXPECT_NEAR(after.angles[9], twisted, 1e-6 * twisted);
  const RodForces forces = stepper.forces();
  for (std::uint32_t i = 0; i < 10; ++i) {
    EXPECT_NEAR(forces.tensions[i], 10.0, 1e-5) << "edge " << i;
  }
  for (std::uint32_t i = 1; i < 10; ++i) {
    EXPECT_NEAR(forces.twisting_moments[i], 0.3, 1e-6) << "node " << i;
  }
  EXPECT_NEAR(forces.holds[0].moment.x(), -0.3, 1e-6);
}

/// Parts of the rod's own section are no parts: the same to rounding errors.
TEST(Sections, OfTheRodItselfChangeNothing) {
  const auto moved = [](bool has_sections) {
    Rods rods;
    rods.add(straight({0, 0, 0}, {1, 0, 0}, 10), 0.01, thin);
    if (has_sections) {
      rods.set_sections(0, {{{0.13, 0.55}, thin}, {{0.55, 1.0}, thin}});
    }
    rods.add(straight({0, 0.1, 0}, {1, 0.1, 0}, 10), 0.01, thin);
    auto twist = std::make_unique<Twist>(rods);
    auto clamped = hold(rods, {clamp(0, {Vector3d::Zero(), Vector3d::UnitX(), rods.directors[0]})});
    Stepper stepper(rods,
                    effects(std::make_unique<Gravity>(Vector3d(0, 0, -9.81)),
                            std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(twist),
                            std::make_unique<Damping>(0.01), std::move(clamped)),
                    precise());
    for (int i = 0; i < 50; ++i) {
      stepper.step(0.01);
    }
    return stepper.rods();
  };
  const Rods plain = moved(false);
  const Rods parted = moved(true);
  for (std::size_t i = 0; i < plain.positions.size(); ++i) {
    EXPECT_LE((plain.positions[i] - parted.positions[i]).norm(), 1e-8);
  }
}

TEST(Sections, ThatOverlapOrLeaveTheRodAreRefused) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {1, 0, 0}, 10), 0.01, thin);
  const auto error = [&](const std::vector<RodSectionPart>& parts) {
    return error_of([&] { rods.set_sections(0, parts); });
  };
  EXPECT_EQ(error({{{0.1, 0.5}, thick}, {{0.4, 0.6}, thick}}),
            "rod 0: section 1 is from 0.400000 to 0.600000 m, it must be behind the one before, "
            "0.500000 m, and within the rod's length, 1.000000 m");
  EXPECT_NE(error({{{0.5, 1.1}, thick}}), "no error");
  EXPECT_NE(error({{{-0.1, 0.5}, thick}}), "no error");
  EXPECT_NE(error({{{0.5, 0.5}, thick}}), "no error");
  EXPECT_EQ(error({{{0.5, 0.6}, {1.0, 0.0, 1.0, 1.0, 1.0}}}),
            "bending_stiffness is 0.000000, it must be positive and finite");
  EXPECT_TRUE(rods.section_lengths.empty());
}

}  // namespace
}  // namespace fiber::test
