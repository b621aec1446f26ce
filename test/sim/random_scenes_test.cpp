// Random scenes whose steps may take as many iterations as they need: materials, sizes, effects,
// integrators, steps, contacts and restitution are drawn. Energy rises by no more than a minimum of
// the incremental potential may, and nothing gets into anything, by a search over all pairs of
// segments. How many steps end short
// of balance is recorded. The suite tries a few scenes, and any other seed (scripts/campaign.sh)
// 200.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "test/sim/random_scene.hpp"
#include "test/sim/tunnelling.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

constexpr int sampled_scenes = 8;     // with the seed of the suite
constexpr int campaign_scenes = 200;  // with any other
constexpr int steps_of_scene = 100;
constexpr double inner_share = 0.9;  // of the sum of radii, in which no axes come

/// The least distance of two axes over the sum of radii, and of an axis from the table over its
/// radius; among all pairs of segments that may touch.
double min_share(const Rods& rods, bool has_table) {
  double least = 1.0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;  // first node, rod
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      if (has_table) {
        least = std::min(least, rods.positions[i].z() / rods.radii[rod]);
      }
      if (i + 1 < rods.end(rod)) {
        edges.emplace_back(i, rod);
      }
    }
  }
  for (std::size_t a = 0; a < edges.size(); ++a) {
    for (std::size_t b = a + 1; b < edges.size(); ++b) {
      const auto [i, rod_a] = edges[a];
      const auto [j, rod_b] = edges[b];
      if (rod_a == rod_b && are_near(rods, i, j)) {
        continue;
      }
      const auto& p = rods.positions;
      least = std::min(least, edge_distance(p[i], p[i + 1], p[j], p[j + 1]) /
                                  (rods.radii[rod_a] + rods.radii[rod_b]));
    }
  }
  return least;
}

TEST(RandomScenes, KeepApartBalanceAndGainNoEnergy) {
  SCOPED_TRACE(seed_message());
  Random random;
  int unbalanced = 0;
  std::string unbalanced_scenes;
  const int count = run_seed() == fixed_seed ? sampled_scenes : campaign_scenes;
  for (int round = 0; round < rounds(count); ++round) {
    RandomScene scene = RandomSceneMaker(random, Iterations::ENOUGH).make();
    SCOPED_TRACE("round " + std::to_string(round) + ": " + scene.description);
    double mass = 0.0;
    for (const double each : scene.rods.masses) {
      mass += each;
    }
    const bool is_euler = scene.options.integrator == Integrator::IMPLICIT_EULER;
    const double before = energy_at_start(scene.effects, scene.rods, scene.step);
    const double scale = std::abs(before) + mass * standard_gravity * 1.5;
    const bool is_driven = scene.is_windy || scene.is_inextensible;
    const double start = min_share(scene.rods, scene.has_table);
    // Only of implicit Euler on one thread does the path tell the way of a step, which is not
    // straight.
    scene.options.threads = 1;
    SolverPath path;
    scene.effects.push_back(path.watcher());
    Stepper stepper(std::move(scene.rods), std::move(scene.effects), scene.options,
                    std::move(scene.contacts));
    int unbalanced_here = 0;
    std::string problem;
    for (int i = 0; i < steps_of_scene && problem.empty(); ++i) {
      const Rods last = stepper.rods();
      stepper.step(scene.step);
      const StepReport& report = stepper.report();
      unbalanced_here += report.unbalanced > 0 ? 1 : 0;
      const double share = min_share(stepper.rods(), scene.has_table);
      std::ostringstream told;
      if (!all_finite(stepper.rods())) {
        told << "numbers that are not finite";
      } else if (const std::string pair =
                     is_euler ? TunnellingChecker::check(stepper.rods(), path) : "";
                 !pair.empty()) {
        told << pair << " pass through each other";
      } else if (share < std::min(start, inner_share)) {
        told << "axes at " << share << " of the sum of radii";
      } else if (const auto gain =
                     gains_no_more_than_it_may(stepper, last, scene.has_friction, 1e-9 * scale);
                 !is_driven && is_euler && !gain) {
        told << gain.message();
      } else if (!is_driven && stepper.energy() > before + (is_euler ? 1e-2 : 0.5) * scale) {
        told << "has " << stepper.energy() << " J, began with " << before << " of " << scale;
      }
      problem = told.str().empty() ? "" : "step " + std::to_string(i) + ": " + told.str();
    }
    EXPECT_EQ(problem, "");
    if (unbalanced_here > 0) {
      unbalanced_scenes += std::to_string(unbalanced_here) + " steps of round " +
                           std::to_string(round) + ": " + scene.description + "\n";
    }
    unbalanced += unbalanced_here;
  }
  RecordProperty("unbalanced_steps", unbalanced);
  RecordProperty("unbalanced_scenes", unbalanced_scenes);
}

}  // namespace
}  // namespace fiber::test
