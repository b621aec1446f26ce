// Rods of equal sizes are moved in lanes side by side: each must move as it does alone.

#include <gtest/gtest.h>

#include "fiber_proximity/sim/effects/damping.hpp"
#include "fiber_proximity/sim/effects/drag.hpp"
#include "sim/random_rods.hpp"
#include "sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// A chain, how it moves, and whether it is clamped where it begins, pinned there, or free.
struct Thrown {
  std::vector<Vector3d> points;
  std::vector<Vector3d> velocities;
  RodSection section;
  int hold = 0;
};

Thrown random_rod(Random& random, int nodes, double speed) {
  Thrown rod{random_chain(random, nodes, 0.1), {}, random_section(random), random.integer(0, 2)};
  for (int i = 0; i < nodes; ++i) {
    rod.velocities.push_back(random.in_cube(speed));
  }
  return rod;
}

enum class Scene { ALL_IN_LANES, WITH_DAMPING };

/// Where the rods are after some steps together.
std::vector<Vector3d> together(const std::vector<Thrown>& thrown, Scene scene,
                               Integrator integrator, int steps) {
  Rods rods;
  auto held = std::make_unique<Attachment>();
  for (const Thrown& each : thrown) {
    rods.add(each.points, 0.01, each.section);
    std::copy(each.velocities.begin(), each.velocities.end(),
              rods.velocities.end() - static_cast<std::ptrdiff_t>(each.velocities.size()));
    const Vector3d start = each.points.front();
    Attachment::Hold hold = pin(0, start);
    if (each.hold == 2) {
      hold = clamp(0, {start, Vector3d::UnitX(), Vector3d::UnitY()});
    }
    hold.rod = rods.count() - 1;
    if (each.hold > 0) {
      held->add(rods, hold);
    }
  }
  Drag::Options wind;
  wind.wind.mean = {5.0, 1.0, 0.0};
  wind.wind.gust = {2.0, 0.0, 1.0};
  Effects all =
      effects(std::make_unique<Gravity>(Vector3d(0, 0, -9.81)), std::make_unique<Stretch>(),
              std::make_unique<Bend>(), std::make_unique<Drag>(wind), std::move(held));
  if (scene == Scene::WITH_DAMPING) {
    all.push_back(std::make_unique<Damping>(0.01));
  }
  StepperOptions options;
  options.integrator = integrator;
  Stepper stepper(rods, std::move(all), options);
  for (int i = 0; i < steps; ++i) {
    stepper.step(0.01);
  }
  return stepper.rods().positions;
}

class SideBySide : public testing::TestWithParam<std::tuple<Scene, Integrator>> {
 protected:
  std::vector<Vector3d> run(const std::vector<Thrown>& thrown, int steps) const {
    return together(thrown, std::get<0>(GetParam()), std::get<1>(GetParam()), steps);
  }
};

TEST_P(SideBySide, RodsMoveAsEachDoesAlone) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < 10; ++round) {
    std::vector<Thrown> thrown;
    for (int rod = 0; rod < 15; ++rod) {
      // Slow ones, and ones so fast that Newton's method begins again from where they were.
      thrown.push_back(random_rod(random, random.integer(2, 5), rod % 2 == 0 ? 1.0 : 100.0));
    }
    // Rounding errors differ, and grow with what is thrown.
    constexpr int steps = 5;
    const std::vector<Vector3d> found = run(thrown, steps);
    std::size_t node = 0;
    for (std::size_t rod = 0; rod < thrown.size(); ++rod) {
      for (const Vector3d& expected : run({thrown[rod]}, steps)) {
        ASSERT_LE((found[node] - expected).norm(), 1e-6) << "rod " << rod << ", node " << node;
        ++node;
      }
    }
  }
}

TEST_P(SideBySide, RodsMoveWhateverIsBesideThem) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  for (int round = 0; round < 10; ++round) {
    const Thrown rod = random_rod(random, 6, 1.0);
    const auto with_it = [&](std::size_t before, std::size_t count, double speed) {
      std::vector<Thrown> thrown(count);
      for (Thrown& each : thrown) {
        each = random_rod(random, 6, speed);
      }
      thrown[before] = rod;
      const std::vector<Vector3d> all = run(thrown, 30);
      const auto first = all.begin() + static_cast<std::ptrdiff_t>(6 * before);
      return std::vector<Vector3d>(first, first + 6);
    };
    const std::vector<Vector3d> once = with_it(0, 2, 1.0);
    EXPECT_EQ(with_it(3, 4, 1000.0), once);
    EXPECT_EQ(with_it(4, 6, 0.0), once);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SideBySide,
                         testing::Combine(testing::Values(Scene::ALL_IN_LANES, Scene::WITH_DAMPING),
                                          testing::Values(Integrator::IMPLICIT_EULER,
                                                          Integrator::IMPLICIT_MIDPOINT)));

}  // namespace
}  // namespace fiber::test
