// Rods with rigid parts, and with parts that are thicker than the rest.

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "fiber_proximity/sim/effects.hpp"
#include "fiber_proximity/sim/loads.hpp"
#include "test/sim/effect_derivatives.hpp"
#include "test/sim/random_rods.hpp"
#include "test/support/error_of.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

const RodSection soft{1e4, 1.0, 0.8, 1.0, 1e-4};
const RodSection plug{5e4, 7.0, 5.0, 3.0, 4e-4};

std::vector<Vector3d> joined(std::vector<Vector3d> points, const std::vector<Vector3d>& more) {
  points.insert(points.end(), more.begin() + 1, more.end());
  return points;
}

/// A rod of 1 m along x that is rigid from 0.4 to 0.6 m, where it is one edge.
Rods rod_with_plug() {
  Rods rods;
  rods.add(joined(joined(straight({0, 0, 0}, {0.4, 0, 0}, 16), {{0.4, 0, 0}, {0.6, 0, 0}}),
                  straight({0.6, 0, 0}, {1, 0, 0}, 16)),
           0.01, soft);
  rods.set_sections(0, {{{arc_to(rods, 0, 16), arc_to(rods, 0, 17)}, plug, 0.03, true}});
  return rods;
}

/// Loads at the last node, in the equilibrium that they have with a clamp at the first one.
Rods loaded(Rods rods, const Vector3d& force, double torque) {
  auto twist = std::make_unique<Twist>(rods);
  auto loads = std::make_unique<Loads>();
  Loads::Load load;
  load.node = rods.node_count(0) - 1;
  load.force = TimeTable<Vector3d>(force);
  load.torque = TimeTable<double>(torque);
  loads->add(rods, load);
  auto clamped = hold(rods, {clamp(0, {Vector3d::Zero(), Vector3d::UnitX(), rods.directors[0]})});
  Stepper stepper(rods,
                  effects(std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(twist),
                          std::move(clamped), std::move(loads)),
                  precise());
  settle(stepper);
  return stepper.rods();
}

/// All of the deflection is the bending of the rest: the integral of the squared lever over it.
TEST(RigidParts, OfACantileverDoNotBend) {
  constexpr double force = 0.01;
  const Rods rods = loaded(rod_with_plug(), {0.0, 0.0, -force}, 0.0);
  const double expected = force * (1.0 - std::pow(0.6, 3) + std::pow(0.4, 3)) / 3.0;
  EXPECT_NEAR(-rods.positions.back().z(), expected, 0.002 * expected);
}

TEST(RigidParts, DoNotTwist) {
  constexpr double torque = 0.3;
  const Rods rods = loaded(rod_with_plug(), Vector3d::Zero(), torque);
  const double expected = torque * (0.8 - 0.5 * 0.025) / soft.twisting_stiffness;
  EXPECT_NEAR(rods.angles[rods.node_count(0) - 2], expected, 1e-6 * expected);
}

/// Along their axis they give way by their own stiffness.
TEST(RigidParts, StretchByTheirMaterial) {
  constexpr double force = 10.0;
  const Rods rods = loaded(rod_with_plug(), {force, 0.0, 0.0}, 0.0);
  const double longer = rods.positions[17].x() - rods.positions[16].x() - 0.2;
  EXPECT_NEAR(longer, 0.2 * force / plug.stretching_stiffness, 1e-9);
}

TEST(RigidParts, HaveMassesOfTheirOwn) {
  const Rods rods = rod_with_plug();
  EXPECT_NEAR(std::accumulate(rods.masses.begin(), rods.masses.end(), 0.0), 0.8 + 0.2 * 3.0, 1e-12);
  EXPECT_NEAR(rods.masses[16], 0.5 * (0.025 + 0.2 * 3.0), 1e-12);
}

/// A clamp at a rigid end holds it by the plug's material; the bends beside it are the rest's.
TEST(RigidParts, AtAClampedEnd) {
  Rods rods;
  rods.add(joined({{0, 0, 0}, {0.2, 0, 0}}, straight({0.2, 0, 0}, {1, 0, 0}, 32)), 0.01, soft);
  rods.set_sections(0,
                    {{{0.0, arc_to(rods, 0, 1)}, {5e4, 1e4, 1e4, 3.0, 4e-4}, std::nullopt, true}});
  constexpr double force = 0.01;
  const Rods after = loaded(std::move(rods), {0.0, 0.0, -force}, 0.0);
  const double expected = force * std::pow(0.8, 3) / 3.0;
  EXPECT_NEAR(-after.positions.back().z(), expected, 0.002 * expected);
}

TEST(RigidParts, DerivativesAreThoseOfTheEnergy) {
  SCOPED_TRACE(seed_message());
  Random random(32);
  for (int round = 0; round < 20; ++round) {
    Rods rods;
    rods.add(random_chain(random, 6, 0.3), 0.01, random_section(random));
    rods.set_sections(
        0, {{{arc_to(rods, 0, 2), arc_to(rods, 0, 3)}, random_section(random), 0.02, true},
            {{arc_to(rods, 0, 4), arc_to(rods, 0, 5)}, random_section(random), 0.03, true}});
    std::vector<std::shared_ptr<Effect>> effects{
        std::make_shared<Stretch>(), std::make_shared<Bend>(), std::make_shared<Damping>(0.02)};
    if (round % 2 == 0) {
      effects.push_back(std::make_shared<Twist>(rods));
    }
    for (const auto& effect : effects) {
      effect->begin_step(rods, {0.0, 0.01});
    }
    displace(rods, random, 0.03, 0.5);
    for (const auto& effect : effects) {
      const Eigen::VectorXd found = derivatives_of(*effect, rods, 0).gradient;
      const Eigen::VectorXd expected = gradient_by_differences(*effect, rods, 0, 1e-6);
      ASSERT_LE((found - expected).norm(), 1e-5 * (1.0 + expected.norm())) << "round " << round;
      expect_same_side_by_side(*effect, rods);
    }
  }
}

TEST(RigidParts, RadiiAreThoseOfEdges) {
  Rods rods = rod_with_plug();
  EXPECT_EQ(rods.radii[0], 0.03) << "the largest";
  EXPECT_EQ(rods.edge_radius(0, 15), 0.01);
  EXPECT_EQ(rods.edge_radius(0, 16), 0.03);
  EXPECT_EQ(rods.edge_radius(0, 17), 0.01);
  EXPECT_EQ(rods.node_radius(0, 15), 0.01);
  EXPECT_EQ(rods.node_radius(0, 16), 0.03);
  EXPECT_EQ(rods.node_radius(0, 17), 0.03);
  rods.add(straight({0, 1, 0}, {1, 1, 0}, 2), 0.02, soft);
  EXPECT_EQ(rods.edge_radius(1, 34 + 1), 0.02);
  const std::vector<double> of_points = rods.assembly_radii();
  ASSERT_EQ(of_points.size(), rods.positions.size());
  EXPECT_EQ(of_points[15], 0.01);
  EXPECT_EQ(of_points[16], 0.03) << "alone between thinner ones: of the edge before as well";
  EXPECT_EQ(of_points[17], 0.01);
  EXPECT_EQ(of_points.back(), 0.02);
}

TEST(RigidParts, AtAnEndOrOfSeveralEdgesHaveTheirRadiiAlone) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {1, 0, 0}, 10), 0.01, soft);
  rods.set_sections(0, {{{0.0, arc_to(rods, 0, 1)}, plug, 0.03, true},
                        {{arc_to(rods, 0, 4), arc_to(rods, 0, 7)}, plug, 0.02, false}});
  EXPECT_EQ(rods.assembly_radii(), (std::vector<double>{0.03, 0.01, 0.01, 0.01, 0.01, 0.02, 0.02,
                                                        0.01, 0.01, 0.01, 0.01}));
}

TEST(RigidParts, ThatCannotBeAreRefused) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {1, 0, 0}, 10), 0.01, soft);
  const auto error = [&](const std::vector<RodSectionPart>& parts) {
    return error_of([&] { rods.set_sections(0, parts); });
  };
  const auto part = [&](std::uint32_t from, std::uint32_t to) {
    return RodPart{arc_to(rods, 0, from), arc_to(rods, 0, to)};
  };
  EXPECT_EQ(error({{{0.15, 0.5}, plug, 0.02}}),
            "rod 0: section 0 has a radius of its own or is rigid, it must go from one node to "
            "another, not from 0.150000 to 0.500000 m");
  EXPECT_EQ(error({{part(1, 3), plug, std::nullopt, true}}),
            "rod 0: section 0 is rigid and of 2 edges, it must be one");
  EXPECT_EQ(error({{part(1, 2), plug, std::nullopt, true}, {part(2, 3), plug, 0.02, true}}),
            "rod 0: section 1 is rigid as the one right before it: they must be one");
  EXPECT_EQ(error({{part(1, 2), plug, -1.0}}),
            "rod 0: section 0 has the radius -1.000000, it must be positive and finite");
  EXPECT_TRUE(rods.edge_radii.empty());
  EXPECT_TRUE(rods.mass_couplings.empty());
  EXPECT_TRUE(rods.section_lengths.empty());
}

}  // namespace
}  // namespace fiber::test
