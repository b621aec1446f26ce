// Rods that may touch are moved together, and others do not matter to them.

#include <gtest/gtest.h>

#include <algorithm>

#include "src/sim/solver/stage_solver.hpp"
#include "test/sim/random_rods.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// Rods that will hit each other and a table.
void add_heap(Random& random, const Vector3d& place, Rods& rods) {
  const double radius = random.uniform(0.002, 0.01);
  for (int rod = random.integer(1, 3); rod > 0; --rod) {
    std::vector<Vector3d> points = random_chain(random, random.integer(2, 8), 0.05);
    const Vector3d offset = place + Vector3d(0.0, 0.0, 0.1 * rod) - points.front();
    for (Vector3d& point : points) {
      point += offset;
      point.z() = std::max(point.z(), 2.0 * radius);
    }
    rods.add(points, radius, rubber(radius));
    const Vector3d velocity = random.in_cube(3.0);
    for (std::uint32_t i = rods.first(rods.count() - 1); i < rods.positions.size(); ++i) {
      rods.velocities[i] = velocity;
    }
  }
}

/// Nothing resists stretch: rods of the heap shrink to nothing, and no step is found for them.
TEST(Islands, WhatFallsAloneFallsFreelyWhateverBecomesOfOthers) {
  SCOPED_TRACE(seed_message());
  Random random;
  constexpr double step = 0.005;
  for (int round = 0; round < rounds(40); ++round) {
    Rods rods;
    add_heap(random, Vector3d::Zero(), rods);
    const std::uint32_t first = rods.first(rods.count());
    const Vector3d start(0.0, 20.0, 3.0);  // as far as no step goes
    rods.add({start, start + Vector3d(0.3, 0.0, 0.0)}, 0.005, rubber(0.005));
    Effects effects = elastic(standard_gravity);
    effects.erase(effects.begin());
    Stepper stepper(rods, std::move(effects), StepperOptions{},
                    contacts_with(environment_of(HalfSpaceShape{}), 0.3));
    double speed = 0.0;
    double height = start.z();
    for (int i = 0; i < 100; ++i) {
      stepper.step(step);
      speed += standard_gravity * step;
      height -= speed * step;
      ASSERT_NEAR(stepper.rods().positions[first].z(), height, 1e-9)
          << "round " << round << ", step " << i;
    }
  }
}

}  // namespace
}  // namespace fiber::test
