// What impulses do to rods with rigid parts, beside a dense mass matrix and beside rigid bodies.
#include "src/sim/inertia.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "fiber_proximity/sim/effects.hpp"
#include "src/sim/contact/impact.hpp"
#include "test/sim/random_rods.hpp"
#include "test/support/random.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Six edges, of which the first and the fourth are rigid.
Rods rod_with_plugs(Random& random) {
  Rods rods;
  rods.add(random_chain(random, 7, 0.3), 0.01, random_section(random));
  rods.set_sections(
      0, {{{0.0, arc_to(rods, 0, 1)}, random_section(random), 0.02, true},
          {{arc_to(rods, 0, 3), arc_to(rods, 0, 4)}, random_section(random), 0.03, true}});
  give_velocities(rods, random, 1.0);
  return rods;
}

/// The masses of the nodes, and between those of bars what makes them bars.
MatrixXd mass_matrix(const Rods& rods) {
  const auto count = static_cast<Eigen::Index>(rods.masses.size());
  MatrixXd matrix = Eigen::Map<const VectorXd>(rods.masses.data(), count).asDiagonal();
  for (Eigen::Index edge = 0; edge + 1 < count; ++edge) {
    const double coupling = rods.mass_couplings[static_cast<std::size_t>(edge)];
    Eigen::Matrix2d bar;
    bar << -coupling, coupling, coupling, -coupling;
    matrix.block<2, 2>(edge, edge) += bar;
  }
  return matrix;
}

TEST(Inertia, OfABarIsThatOfAUniformOne) {
  Rods rods;
  constexpr double mass = 3.0;
  constexpr double length = 0.5;
  const RodSection section{1e4, 1.0, 1.0, mass / length, 1e-4};
  rods.add(straight({0, 0, 0}, {length, 0, 0}, 1), 0.01, section);
  rods.set_sections(0, {{{0.0, length}, section, std::nullopt, true}});
  EXPECT_NEAR(mass_against_impulse(rods, 0), mass / 4.0, 1e-15 * mass);
  constexpr double spin = 2.0;
  rods.velocities = {{0.0, -0.5 * length * spin, 0.0}, {0.0, 0.5 * length * spin, 0.0}};
  double energy = 0.0;
  add_kinetic_energy(rods, 0, energy);
  EXPECT_NEAR(energy, 0.5 * mass * length * length / 12.0 * spin * spin, 1e-15);
}

TEST(Inertia, ImpulsesChangeVelocitiesAsTheMassMatrixSays) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < 50; ++round) {
    const Rods before = rod_with_plugs(random);
    const MatrixXd inverse = mass_matrix(before).inverse();
    for (std::uint32_t node = 0; node < before.node_count(0); ++node) {
      SCOPED_TRACE(node);
      const Vector3d impulse = random.in_cube(1.0);
      Rods after = before;
      change_velocity(after, node, impulse / mass_against_impulse(after, node));
      for (std::uint32_t other = 0; other < before.node_count(0); ++other) {
        const Vector3d change = after.velocities[other] - before.velocities[other];
        const double mobility = inverse(other, node);
        EXPECT_LE((change - mobility * impulse).norm(),
                  1e-12 * impulse.norm() / before.masses[node])
            << "of node " << other;
      }
      if (node + 1 < before.node_count(0)) {
        EXPECT_NEAR(coupled_mobility(before, node), inverse(node, node + 1),
                    1e-12 * inverse.norm());
      }
      double energy = 0.0;
      add_kinetic_energy(after, 0, energy);
      EXPECT_NEAR(energy, kinetic_energy(after, 0), 1e-12 * energy) << "beside that of the tests";
    }
  }
}

/// Where a node is of a joint, all of the joint has the impulse.
TEST(Inertia, JoinedNodesAreNotCoupled) {
  SCOPED_TRACE(seed_message());
  Random random;
  Rods rods = rod_with_plugs(random);
  rods.joints.assign(rods.positions.size(), -1);
  rods.joints[1] = 0;
  for (const std::uint32_t node : {0U, 1U}) {
    EXPECT_FALSE(coupled_node(rods, node));
    EXPECT_EQ(mass_against_impulse(rods, node), rods.masses[node]);
  }
  EXPECT_EQ(coupled_mobility(rods, 0), 0.0);
  EXPECT_EQ(coupled_node(rods, 4), 3U);
}

/// A bar that falls onto a corner, level: a rigid body's textbook answer.
TEST(Inertia, ABarThatIsStruckTurnsAsARigidBody) {
  constexpr double mass = 3.0;
  constexpr double length = 0.5;
  const RodSection section{1e4, 1.0, 1.0, mass / length, 1e-4};
  for (const double place : {0.0, 0.1, 0.5, 0.8}) {
    SCOPED_TRACE(place);
    Rods rods;
    rods.add(straight({0, 0, 0}, {length, 0, 0}, 1), 0.01, section);
    rods.set_sections(0, {{{0.0, length}, section, std::nullopt, true}});
    rods.velocities.assign(2, {0.0, 0.0, -1.0});
    Impact impact;
    impact.points = {0, 0, place, 0, ContactPoints::no_edge, 0.0};
    impact.normal = Vector3d::UnitZ();
    impact.separation = 0.4;
    impact.has_begun = true;
    std::vector<Impact> impacts{impact};
    resolve(rods, 0.0, impacts);
    const double lever = (place - 0.5) * length;
    const double inertia = mass * length * length / 12.0;
    const double impulse = 1.4 / (1.0 / mass + lever * lever / inertia);
    EXPECT_NEAR(impacts.front().pressure, impulse, 1e-5 * impulse);
    const double middle = 0.5 * (rods.velocities[0].z() + rods.velocities[1].z());
    const double spin = (rods.velocities[1].z() - rods.velocities[0].z()) / length;
    EXPECT_NEAR(middle, -1.0 + impulse / mass, 1e-5);
    EXPECT_NEAR(spin, impulse * lever / inertia, 1e-4);
  }
}

/// Thrown, and turning.
TEST(Inertia, ABarInFlightKeepsItsSpin) {
  constexpr double spin = 5.0;
  Rods rods;
  const RodSection section{1e6, 1.0, 1.0, 2.0, 1e-4};
  rods.add(straight({0, 0, 0}, {0.4, 0, 0}, 1), 0.01, section);
  rods.set_sections(0, {{{0.0, 0.4}, section, std::nullopt, true}});
  rods.velocities = {{1.0, -0.2 * spin, 0.0}, {1.0, 0.2 * spin, 0.0}};
  Stepper stepper(rods, effects(std::make_unique<Stretch>()), precise(Integrator::BDF2));
  double before = 0.0;
  add_kinetic_energy(rods, 0, before);
  for (int i = 0; i < 500; ++i) {
    stepper.step(0.001);
  }
  double after = 0.0;
  add_kinetic_energy(stepper.rods(), 0, after);
  EXPECT_NEAR(after, before, 1e-3 * before);
  const Vector3d direction =
      (stepper.rods().positions[1] - stepper.rods().positions[0]).normalized();
  EXPECT_NEAR(std::atan2(direction.y(), direction.x()), spin * 0.5, 1e-2);
}

}  // namespace
}  // namespace fiber::test
