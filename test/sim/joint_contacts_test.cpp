// Contacts of joined and closed rods: rings that are linked stay linked, what is joined does not
// touch itself at the joint, and impacts on a joint move all of it.

#include <gtest/gtest.h>

#include <algorithm>

#include "fiber_proximity/sim/joints.hpp"
#include "src/sim/contact/contact_neighbours.hpp"
#include "test/sim/contact_system.hpp"
#include "test/sim/random_rods.hpp"
#include "test/sim/tunnelling.hpp"
#include "validation/sim/contact_scenes.hpp"
#include "validation/sim/harness_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> ring(const Vector3d& center, const Vector3d& across, double radius,
                           int segments) {
  const Vector3d x = across.unitOrthogonal();
  const Vector3d y = across.cross(x);
  std::vector<Vector3d> points;
  for (int i = 0; i < segments; ++i) {
    const double angle = 2.0 * M_PI * i / segments;
    points.push_back(center + radius * (std::cos(angle) * x + std::sin(angle) * y));
  }
  points.push_back(points.front());
  return points;
}

/// Whether edges of different rods have met since.
bool have_met(const Rods& rods, const std::vector<Vector3d>& before) {
  for (std::uint32_t a = 0; a < rods.count(); ++a) {
    for (std::uint32_t b = a + 1; b < rods.count(); ++b) {
      for (std::uint32_t i = rods.first(a); i + 1 < rods.end(a); ++i) {
        for (std::uint32_t j = rods.first(b); j + 1 < rods.end(b); ++j) {
          const auto edge = [&](std::uint32_t first) {
            return MovingEdge{{before[first], before[first + 1]},
                              {rods.positions[first], rods.positions[first + 1]}};
          };
          if (meet(edge(i), edge(j))) {
            return true;
          }
        }
      }
    }
  }
  return false;
}

TEST(JointContacts, LinkedRingsDoNotPass) {
  constexpr int rings = 5;
  constexpr int segments = 18;
  Rods rods;
  auto joints = std::make_unique<Joints>(Joints::Options{});
  const RodSection section = rubber(0.003);
  for (int i = 0; i < rings; ++i) {
    const Vector3d across = i % 2 == 0 ? Vector3d::UnitY() : Vector3d::UnitX();
    rods.add(ring({0.0, 0.0, -0.036 * i}, across, 0.025, segments), 0.003, section);
    joints->close(rods, static_cast<std::uint32_t>(i));
  }
  auto held = std::make_shared<Attachment>();
  std::uint32_t top = 0;
  for (std::uint32_t i = 0; i < segments; ++i) {
    top = rods.positions[i].z() > rods.positions[top].z() ? i : top;
  }
  held->add(rods, pin(top, rods.positions[top]));
  Effects all = elastic(standard_gravity);
  all.push_back(held);
  // The lowest ring is torn downwards.
  for (std::uint32_t i = rods.first(rings - 1); i < rods.end(rings - 1); ++i) {
    rods.velocities[i] = {1.0, 0.3, -3.0};
  }
  Stepper stepper(rods, std::move(all), StepperOptions{}, contacts_with(nullptr, 0.2),
                  std::move(joints));
  double lowest = 0.0;
  for (int i = 0; i < 360; ++i) {
    const std::vector<Vector3d> before = stepper.rods().positions;
    stepper.step(1.0 / 240.0);
    ASSERT_TRUE(all_finite(stepper.rods()));
    ASSERT_FALSE(have_met(stepper.rods(), before)) << "step " << i;
    for (const Vector3d& position : stepper.rods().positions) {
      lowest = std::min(lowest, position.z());
    }
  }
  // Linked rings hang from each other, each a diameter long at most, but for its stretch.
  EXPECT_GT(lowest, -rings * 0.06);
  EXPECT_GT(stepper.report().coupled_rods, 1U);
  for (std::uint32_t rod = 0; rod < rings; ++rod) {
    EXPECT_EQ(stepper.rods().positions[stepper.rods().first(rod)],
              stepper.rods().positions[stepper.rods().end(rod) - 1]);
  }
}

/// Threads that are joined where they cross, from above; the corners are held.
TEST(JointContacts, NetHangsByItsCorners) {
  constexpr int threads = 5;
  constexpr int per_mesh = 3;
  constexpr double mesh = 0.03;
  constexpr double length = mesh * (threads - 1);
  constexpr int segments = per_mesh * (threads - 1);
  Rods rods;
  for (int i = 0; i < threads; ++i) {
    rods.add(straight({0.0, mesh * i, 0.0}, {length, mesh * i, 0.0}, segments), 0.001,
             rubber(0.001));
  }
  for (int i = 0; i < threads; ++i) {
    rods.add(straight({mesh * i, 0.0, 0.0}, {mesh * i, length, 0.0}, segments), 0.001,
             rubber(0.001));
  }
  auto joints = std::make_unique<Joints>(Joints::Options{});
  for (std::uint32_t i = 0; i < threads; ++i) {
    for (std::uint32_t j = 0; j < threads; ++j) {
      joints->add(rods, {Joints::Kind::WELD, {{i, per_mesh * j}, {threads + j, per_mesh * i}}});
    }
  }
  auto held = std::make_shared<Attachment>();
  for (const std::uint32_t rod : {0, threads - 1}) {
    for (const std::uint32_t node : {0, segments}) {
      Attachment::Hold corner = pin(node, rods.positions[rods.first(rod) + node]);
      corner.rod = rod;
      held->add(rods, corner);
    }
  }
  Effects all = elastic(standard_gravity);
  all.push_back(held);
  double weight = 0.0;
  for (const double mass : rods.masses) {
    weight += standard_gravity * mass;
  }
  Stepper stepper(rods, std::move(all), StepperOptions{}, contacts_with(nullptr),
                  std::move(joints));
  for (int i = 0; i < 60; ++i) {
    stepper.step(1.0 / 240.0);
    ASSERT_EQ(stepper.report().unbalanced, 0U) << i;
  }
  for (const RodForces::ContactForce& contact : stepper.forces().contacts) {
    EXPECT_EQ(contact.normal_force.norm(), 0.0);
  }
  settle(stepper);
  Vector3d force = Vector3d::Zero();
  for (const RodForces::HoldForce& hold : stepper.forces().holds) {
    force += hold.force;
    EXPECT_NEAR(hold.force.z(), 0.25 * weight, 1e-4 * weight);
  }
  EXPECT_NEAR(force.z(), weight, 1e-6 * weight);
}

TEST(JointContacts, NeighboursAreSoAlongTheShortestWay) {
  Rods rods;
  rods.add(straight({0.0, 0.0, 0.0}, {0.4, 0.0, 0.0}, 40), 0.005, rubber(0.005));
  rods.add(straight({0.2, 0.0, 0.0}, {0.2, 0.2, 0.0}, 20), 0.003, rubber(0.003));
  rods.add(ring({0.0, 0.0, 1.0}, Vector3d::UnitX(), 0.1, 40), 0.005, rubber(0.005));
  Joints joints(Joints::Options{});
  joints.close(rods, 2);
  joints.add(rods, {Joints::Kind::WELD, {{0, 20}, {1, 0}}});
  const ContactNeighbours neighbours(rods);
  const auto are_near = [&](std::uint32_t rod_a, std::uint32_t edge_a, std::uint32_t rod_b,
                            std::uint32_t edge_b) {
    const bool found = neighbours.contain(rods, rod_a, rods.first(rod_a) + edge_a, rod_b,
                                          rods.first(rod_b) + edge_b);
    EXPECT_EQ(found, neighbours.contain(rods, rod_b, rods.first(rod_b) + edge_b, rod_a,
                                        rods.first(rod_a) + edge_a));
    return found;
  };
  EXPECT_TRUE(are_near(0, 19, 1, 0));
  EXPECT_TRUE(are_near(0, 20, 1, 0));
  EXPECT_TRUE(are_near(0, 21, 1, 0)) << "1 cm between, 1.6 are the least";
  EXPECT_TRUE(are_near(0, 18, 1, 0));
  EXPECT_FALSE(are_near(0, 22, 1, 0));
  EXPECT_FALSE(are_near(0, 18, 1, 1));
  EXPECT_TRUE(are_near(2, 39, 2, 0));
  EXPECT_TRUE(are_near(2, 38, 2, 0)) << "1.6 cm between, 2 are the least";
  EXPECT_FALSE(are_near(2, 37, 2, 0));
  EXPECT_FALSE(are_near(2, 20, 2, 0));
  EXPECT_FALSE(are_near(0, 0, 2, 0));
}

/// By as many ways as there are through joints, each of which is gone once.
TEST(JointContacts, NeighboursAreFoundHoweverThickRodsAre) {
  Rods rods;
  for (int i = 0; i < 12; ++i) {
    rods.add(ring({0.1 * i, 0.0, 0.0}, Vector3d::UnitZ(), 0.05, 12), 4000.0, rubber(0.005));
  }
  Joints joints(Joints::Options{});
  for (std::uint32_t i = 0; i < 12; ++i) {
    joints.close(rods, i);
  }
  for (std::uint32_t i = 0; i + 1 < 12; ++i) {
    rods.positions[rods.first(i + 1)] = rods.positions[rods.first(i) + 6];
    rods.positions[rods.end(i + 1) - 1] = rods.positions[rods.first(i) + 6];
    joints.add(rods, {Joints::Kind::BALL, {{i, 6}, {i + 1, 0}}});
  }
  const ContactNeighbours neighbours(rods);
  EXPECT_TRUE(neighbours.contain(rods, 0, 3, 11, rods.first(11) + 8));
}

/// A ring that is pinched has contact forces there, wherever its seam is.
TEST(JointContacts, WhatTouchesHasABarrierWhereverTheSeamIs) {
  constexpr int segments = 16;
  constexpr double radius = 0.005;
  std::vector<double> energies;
  for (int seam = 0; seam < segments; ++seam) {
    std::vector<Vector3d> points;
    for (int i = 0; i <= segments; ++i) {
      const double angle = 2.0 * M_PI * ((i + seam) % segments) / segments;
      const double width = std::abs(std::cos(angle)) < 0.1 ? 0.0048 : 0.03;
      points.emplace_back(0.06 * std::cos(angle), width * std::sin(angle), 0.0);
    }
    Rods rods;
    rods.add(points, radius, rubber(radius));
    Joints joints(Joints::Options{});
    joints.close(rods, 0);
    const auto contacts = contacts_with(nullptr);
    ContactSet found = contacts_of(*contacts, rods);
    energies.push_back(energy_in(found, rods));
  }
  const auto [least, most] = std::minmax_element(energies.begin(), energies.end());
  EXPECT_GT(*least, 0.0);
  EXPECT_LE(*most, 4.0 * *least) << "what lies on the seam has the barrier of each end";
}

/// Two like rods that are joined at their ends fall flat: they part from the floor as one does.
TEST(JointContacts, ImpactsOnAJointMoveAllOfIt) {
  Rods rods;
  rods.add(straight({-0.2, 0.0, 0.0}, {0.0, 0.0, 0.0}, 6), 0.004, rubber(0.004));
  rods.add(straight({0.0, 0.0, 0.0}, {0.2, 0.0, 0.0}, 6), 0.004, rubber(0.004));
  auto joints = std::make_unique<Joints>(Joints::Options{});
  joints->add(rods, {Joints::Kind::BALL, {{0, 6}, {1, 0}}});
  for (Vector3d& velocity : rods.velocities) {
    velocity = {0.0, 0.0, -1.0};
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().z() = -0.02;
  Stepper stepper(rods, elastic(), StepperOptions{},
                  contacts_with(environment_of(HalfSpaceShape{}, pose)), std::move(joints));
  const double before = kinetic_energy(rods);
  std::uint32_t impacts = 0;
  for (int i = 0; i < 30; ++i) {
    stepper.step(0.002);
    impacts += stepper.report().impacts;
    const Rods& now = stepper.rods();
    ASSERT_EQ(now.positions[6], now.positions[7]);
    ASSERT_EQ(now.velocities[6], now.velocities[7]);
    ASSERT_LE(stepper.energy(), before * (1.0 + 1e-6));
  }
  EXPECT_GT(impacts, 0U);
  for (const Vector3d& velocity : stepper.rods().velocities) {
    EXPECT_NEAR(velocity.z(), default_restitution, 2e-3);
  }
}

/// Its branches stay at the trunk's end, to the last bit, while they swing and touch.
TEST(JointContacts, AHarnessOnAnArmBalancesInEachStep) {
  StepperOptions options;
  options.threads = 1;
  Stepper stepper = harness_on_an_arm({}, options);
  std::size_t contacts = 0;
  for (int i = 0; i < 360; ++i) {
    stepper.step(1.0 / 240.0);
    ASSERT_EQ(stepper.report().unbalanced, 0U)
        << "step " << i << ": " << stepper.report().worst.residual << " m/s";
    contacts = std::max(contacts, stepper.forces().contacts.size());
  }
  EXPECT_GT(contacts, 5U);
  const Rods& rods = stepper.rods();
  for (std::uint32_t branch = 1; branch < rods.count(); ++branch) {
    EXPECT_EQ(rods.positions[rods.first(branch)], rods.positions[rods.end(0) - 1]);
  }
  EXPECT_GT((rods.positions.front() - Vector3d(-0.5, 0.0, 1.0)).norm(), 0.1) << "it has swung";
}

}  // namespace
}  // namespace fiber::test
