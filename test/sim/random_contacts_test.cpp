// Random subsets of all effects with random parameters, contacts among them, for ten thousand
// steps of few iterations: nothing passes through anything, nothing blows up, and what energy a
// step may have gained is told.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fiber_proximity/sim/effects.hpp"
#include "test/sim/energy_bounds.hpp"
#include "test/sim/random_rods.hpp"
#include "test/sim/random_scene.hpp"
#include "test/sim/tunnelling.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

constexpr int scenes = 40;
constexpr int steps_of_first = 10000;
constexpr int steps_of_others = 250;
constexpr double most_gained = 1.0;  // by steps of one to three iterations, of what there was
constexpr double top = 1.5;          // [m] rods begin below, above a table at 0

TEST(RandomContacts, NothingPassesThroughAnythingOrBlowsUp) {
  SCOPED_TRACE(seed_message());
  Random random;
  double moved = 0.0;  // [m] the least of a scene's fastest rods
  for (int round = 0; round < rounds(scenes); ++round) {
    RandomScene scene = RandomSceneMaker(random).make();
    SCOPED_TRACE("round " + std::to_string(round) + ": " + scene.description);
    double weight = 0.0;  // [N]
    for (const double mass : scene.rods.masses) {
      weight += mass * standard_gravity;
    }
    const double before = energy_at_start(scene.effects, scene.rods, scene.step);
    const std::vector<Vector3d> start = scene.rods.positions;
    // Inextensible edges learn what tension they are to have, and store a little more or less by
    // that.
    const double scale = std::abs(before) + weight * top;
    const double slack = (scene.is_inextensible ? 1.0 : 1e-9) * scale;
    Stepper stepper(std::move(scene.rods), std::move(scene.effects), scene.options,
                    std::move(scene.contacts));
    TunnellingChecker checker(stepper.rods());
    const int steps = round == 0 ? steps_of_first : steps_of_others;
    for (int i = 0; i < steps; ++i) {
      const Rods last = stepper.rods();
      stepper.step(scene.step);
      ASSERT_TRUE(all_finite(stepper.rods())) << "step " << i;
      ASSERT_EQ(checker.check(stepper.rods()), "") << "step " << i;
      if (!scene.is_windy) {
        ASSERT_TRUE(gains_no_more_than_it_may(stepper, last, scene.has_friction, slack))
            << "step " << i;
        ASSERT_LE(stepper.energy(), before + most_gained * (scale + kinetic_energy(stepper.rods())))
            << "step " << i;
      }
    }
    double farthest = 0.0;
    for (std::size_t i = 0; i < start.size(); ++i) {
      farthest = std::max(farthest, (stepper.rods().positions[i] - start[i]).norm());
    }
    moved = round == 0 ? farthest : std::min(moved, farthest);
  }
  EXPECT_GT(moved, 0.01);
}

/// Without resistance to stretch, rods that hit a table shrink to nothing, where no step leads on.
TEST(RandomContacts, StepsThatAreCutShortTellWhatTheyGain) {
  SCOPED_TRACE(seed_message());
  Random random;
  double gained = 0.0;         // the most, of what there was
  double gained_freely = 0.0;  // the same, without friction and impacts
  for (int round = 0; round < rounds(60); ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const bool has_friction = round % 2 == 0;
    Rods rods = random_rods_apart(random, 0.3);
    Effects effects = elastic(standard_gravity);
    effects.erase(effects.begin());
    constexpr double step = 0.007;
    const double first = energy_at_start(effects, rods, step);
    const double scale = std::abs(first);
    StepperOptions options;
    options.max_iterations = static_cast<std::uint32_t>(random.integer(1, 3));
    Stepper stepper(rods, std::move(effects), options,
                    contacts_with(environment_of(HalfSpaceShape{}), has_friction ? 0.3 : 0.0));
    double energy = first;
    for (int i = 0; i < 100; ++i) {
      const Rods last = stepper.rods();
      stepper.step(step);
      const StepReport& report = stepper.report();
      ASSERT_NEAR(stepper.energy(), energy + report.energy_gain, 1e-9 * scale) << "step " << i;
      ASSERT_TRUE(gains_no_more_than_it_may(stepper, last, has_friction, 1e-9 * scale))
          << "step " << i;
      if (!has_friction && report.impacts == 0) {
        gained_freely = std::max(gained_freely, report.energy_gain / scale);
      }
      ASSERT_LE(stepper.energy(), first + most_gained * scale) << "step " << i;
      gained = std::max(gained, report.energy_gain / scale);
      energy = stepper.energy();
    }
  }
  expect_enough(gained, 1e-3);
  expect_enough(gained_freely, 1e-3);
}

}  // namespace
}  // namespace fiber::test
