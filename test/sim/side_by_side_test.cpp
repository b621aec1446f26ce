// Rods of equal sizes are moved in lanes side by side: each must move as it does alone.

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "fiber_proximity/sim/effects.hpp"
#include "test/sim/random_rods.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// A chain, how it moves, and whether it is clamped where it begins, pinned there, or free.
struct Thrown {
  std::vector<Vector3d> points;
  std::vector<Vector3d> velocities;
  std::vector<double> spins;
  RodSection section;
  int hold = 0;
};

Thrown random_rod(Random& random, int nodes, double speed) {
  Thrown rod{
      random_chain(random, nodes, 0.1), {}, {}, random_section(random), random.integer(0, 2)};
  if (random.chance(0.3)) {
    rod.points = straight({0.0, 0.0, 0.0}, {0.5, 0.0, 0.0}, nodes - 1);
  }
  for (int i = 0; i < nodes; ++i) {
    rod.velocities.push_back(random.in_cube(speed));
    rod.spins.push_back(random.uniform(-speed, speed));
  }
  return rod;
}

enum class Scene { BASE, INEXTENSIBLE, TWIST, DAMPING, PLASTICITY, ALL };

/// Clamps and pins the rods where they begin.
std::unique_ptr<Attachment> hold(const Rods& rods, const std::vector<Thrown>& thrown) {
  auto held = std::make_unique<Attachment>();
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    const Vector3d start = thrown[rod].points.front();
    Attachment::Hold hold = pin(0, start);
    if (thrown[rod].hold == 2) {
      hold = clamp(0, {start, Vector3d::UnitX(), Vector3d::UnitY()});
    }
    hold.rod = rod;
    if (thrown[rod].hold > 0) {
      held->add(rods, hold);
    }
  }
  return held;
}

/// Gravity, bend, drag, what resists being stretched, and what else there is in a scene.
Effects make_effects(Rods& rods, const std::vector<Thrown>& thrown, Scene scene) {
  Drag::Options wind;
  wind.wind.mean = {5.0, 1.0, 0.0};
  wind.wind.gust = {2.0, 0.0, 1.0};
  Effects all = effects(std::make_unique<Gravity>(Vector3d(0, 0, -9.81)), std::make_unique<Bend>(),
                        std::make_unique<Drag>(wind));
  if (scene == Scene::INEXTENSIBLE) {
    all.push_back(std::make_unique<Inextensible>(rods));
  } else {
    all.push_back(std::make_unique<Stretch>());
  }
  if (scene == Scene::TWIST || scene == Scene::ALL) {
    all.push_back(std::make_unique<Twist>(rods));
  }
  if (scene == Scene::DAMPING || scene == Scene::ALL) {
    all.push_back(std::make_unique<Damping>(0.01));
  }
  if (scene == Scene::PLASTICITY || scene == Scene::ALL) {
    all.push_back(std::make_unique<Plasticity>(rods, Plasticity::Options{}));
  }
  all.push_back(hold(rods, thrown));
  return all;
}

/// Where the rods are after some steps together.
Rods together(const std::vector<Thrown>& thrown, Scene scene, Integrator integrator, int steps) {
  Rods rods;
  for (const Thrown& each : thrown) {
    rods.add(each.points, 0.01, each.section);
    std::copy(each.velocities.begin(), each.velocities.end(),
              rods.velocities.end() - static_cast<std::ptrdiff_t>(each.velocities.size()));
  }
  Effects all = make_effects(rods, thrown, scene);
  for (std::uint32_t rod = 0; rod < rods.count() && !rods.spins.empty(); ++rod) {
    std::copy(thrown[rod].spins.begin(), thrown[rod].spins.end() - 1,
              rods.spins.begin() + rods.first(rod));
  }
  StepperOptions options;
  options.integrator = integrator;
  Stepper stepper(rods, std::move(all), options);
  for (int i = 0; i < steps; ++i) {
    stepper.step(0.01);
  }
  return stepper.rods();
}

/// All numbers that say where a rod is and how it moves.
std::vector<double> motion_of(const Rods& rods, std::uint32_t rod) {
  std::vector<double> motion;
  for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
    for (const Vector3d& v : {rods.positions[i], rods.velocities[i]}) {
      motion.insert(motion.end(), {v.x(), v.y(), v.z()});
    }
    if (!rods.angles.empty()) {
      motion.insert(motion.end(), {rods.angles[i], rods.spins[i]});
    }
  }
  return motion;
}

class SideBySide : public testing::TestWithParam<std::tuple<Scene, Integrator>> {
 protected:
  Rods run(const std::vector<Thrown>& thrown, int steps) const {
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
    constexpr int steps = 5;
    const Rods found = run(thrown, steps);
    for (std::uint32_t rod = 0; rod < found.count(); ++rod) {
      ASSERT_EQ(motion_of(found, rod), motion_of(run({thrown[rod]}, steps), 0)) << "rod " << rod;
    }
  }
}

TEST_P(SideBySide, RodsMoveWhateverIsBesideThem) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  for (int round = 0; round < 10; ++round) {
    const Thrown rod = random_rod(random, 6, 1.0);
    const auto with_it = [&](std::uint32_t before, std::size_t count, double speed) {
      std::vector<Thrown> thrown(count);
      for (Thrown& each : thrown) {
        each = random_rod(random, 6, speed);
      }
      thrown[before] = rod;
      return motion_of(run(thrown, 30), before);
    };
    const std::vector<double> once = with_it(0, 2, 1.0);
    EXPECT_EQ(with_it(3, 4, 1000.0), once);
    EXPECT_EQ(with_it(4, 6, 0.0), once);
  }
}

TEST_P(SideBySide, RodsMoveTheSameOnAnyInstructionSet) {
  SCOPED_TRACE(seed_message());
  Random random(2);
  std::vector<Thrown> thrown;
  for (int rod = 0; rod < 15; ++rod) {
    thrown.push_back(random_rod(random, random.integer(2, 5), 1.0));
  }
  const Rods expected = run(thrown, 30);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    const Rods found = run(thrown, 30);
    for (std::uint32_t rod = 0; rod < found.count(); ++rod) {
      EXPECT_EQ(motion_of(found, rod), motion_of(expected, rod)) << hwy::TargetName(target);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, SideBySide,
    testing::Combine(testing::Values(Scene::BASE, Scene::INEXTENSIBLE, Scene::TWIST, Scene::DAMPING,
                                     Scene::PLASTICITY, Scene::ALL),
                     testing::Values(Integrator::IMPLICIT_EULER, Integrator::BDF2)));

}  // namespace
}  // namespace fiber::test
