// How fibre contacts limit displacements, whatever the step would have wanted.

#include <gtest/gtest.h>

#include <cmath>

#include "fiber_proximity/sim/effects/fiber_contact.hpp"
#include "sim/random_rods.hpp"
#include "sim/tunnelling.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

constexpr double radius = 0.01;

void add_upright(Rods& rods, double x) {
  rods.add({{x, -0.5, 0.0}, {x, 0.5, 0.0}}, radius, {1.0, 1.0, 1.0, 1.0, 1.0});
}

void move(Rods& rods, const std::vector<Vector3d>& displacements) {
  for (std::size_t i = 0; i < displacements.size(); ++i) {
    rods.positions[i] += displacements[i];
  }
}

/// All move nearly alike, so that only the first two come near each other. Once these are to
/// settle, the first stays behind the plane between them, and the third, from far behind, comes to
/// it.
TEST(Limit, WhatFollowsIsStoppedByWhatIsStopped) {
  Rods rods;
  for (const double x : {0.0, 2.1 * radius, -0.5}) {
    add_upright(rods, x);
  }
  FiberContact contact{FiberContact::Options{}};
  contact.begin_step(rods, {0.0, 0.01});
  std::vector<Vector3d> displacements(rods.positions.size(), Vector3d::UnitX());
  displacements[2].x() = displacements[3].x() = 0.98;
  contact.limit(rods, displacements, ContactSource::Way::WHOLE, ContactSource::settling_round);
  TunnellingChecker checker(rods);
  move(rods, displacements);
  EXPECT_LT(rods.positions[0].x(), radius) << "it settles";
  EXPECT_EQ(displacements[2].x(), 0.98) << "nothing is in its way";
  EXPECT_GT(rods.positions[4].x(), -0.5) << "it may move";
  EXPECT_EQ(checker.check(rods), "");
}

/// Displacements of any length, most of them shared, in the first rounds and when all is to settle.
TEST(Limit, NoDisplacementsLeadThroughAnything) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    Rods rods;
    for (int rod = random.integer(2, 6); rod > 0; --rod) {
      rods.add(random_chain(random, random.integer(2, 5), 0.3), radius, random_section(random));
    }
    const double speed = random.chance(0.5) ? 0.0 : 10.0;
    give_velocities(rods, random, speed);
    FiberContact contact{FiberContact::Options{}};
    contact.begin_step(rods, {0.0, 0.01});
    TunnellingChecker checker(rods);
    const Vector3d shared = random.in_cube(2.0);
    std::vector<Vector3d> displacements;
    const double own = std::pow(10.0, random.uniform(-3.0, 0.0));
    for (std::size_t i = 0; i < rods.positions.size(); ++i) {
      displacements.emplace_back(shared + random.in_cube(own));
    }
    contact.limit(rods, displacements, ContactSource::Way::WHOLE,
                  random.chance(0.5) ? ContactSource::settling_round : 0);
    move(rods, displacements);
    ASSERT_EQ(checker.check(rods), "");
  }
}

}  // namespace
}  // namespace fiber::test
