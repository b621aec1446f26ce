// run_tree chooses its skin itself: no answer may show that, frames that follow each other must
// cost less, and others next to nothing more.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "src/query/run_tree_engine.hpp"
#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"
#include "test/support/query_options.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// Where points are in each frame.
struct Motion {
  std::string name;
  std::function<Vector3d(Random& random, std::size_t fiber, int frame, const Vector3d& point)> next;
};

/// @param size [m] of the scene
std::vector<Motion> motions(double size) {
  const auto drift = [](double step, std::size_t fiber, int frame) {
    const double angle = 0.7 * static_cast<double>(fiber);
    return Vector3d((frame / 50 % 2 == 0 ? step : -step) *
                    Vector3d(std::cos(angle), std::sin(angle), 0.3));
  };
  return {
      {"still", [](Random&, std::size_t, int, const Vector3d& point) { return point; }},
      {"drifting",
       [=](Random&, std::size_t fiber, int frame, const Vector3d& point) {
         return Vector3d(point + drift(1e-4 * size, fiber, frame));
       }},
      {"trembling",
       [=](Random& random, std::size_t, int, const Vector3d& point) {
         return Vector3d(point + random.in_cube(1e-4 * size));
       }},
      {"one of ten is fast",
       [=](Random&, std::size_t fiber, int frame, const Vector3d& point) {
         return Vector3d(point + drift((fiber % 10 == 3 ? 0.02 : 1e-6) * size, fiber, frame));
       }},
      {"jumping",
       [=](Random& random, std::size_t, int, const Vector3d& point) {
         return Vector3d(point + random.in_cube(0.05 * size));
       }},
      {"now and then",
       [=](Random& random, std::size_t fiber, int frame, const Vector3d& point) {
         return frame % 30 < 20 ? Vector3d(point + drift(1e-4 * size, fiber, frame))
                                : Vector3d(point + random.in_cube(0.1 * size));
       }},
  };
}

void move(FiberAssembly& fibers, const Motion& motion, Random& random, int frame) {
  std::vector<Vector3d> points = fibers.points();
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    for (std::uint32_t i = fibers.offsets()[fiber]; i < fibers.offsets()[fiber + 1]; ++i) {
      points[i] = motion.next(random, fiber, frame, points[i]);
    }
  }
  fibers.update_points(points);
}

TEST(AutomaticSkinTest, AnswersAsBruteForceHoweverFibersMove) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::size_t found = 0;
  std::uint64_t served = 0;
  constexpr int frames = rounds_less > 1 ? 8 : 25;
  for (int round = 0; round < rounds(1); ++round) {
    for (const AssemblyFamily& family : assembly_families()) {
      SCOPED_TRACE(family.name);
      const FiberAssembly first = family.make(random);
      const double size = extent_of(first);
      for (const Motion& motion : motions(size)) {
        SCOPED_TRACE(motion.name);
        FiberAssembly fibers = first;
        RunTreeEngine engine({1});
        QueryOptions options = random_options(random, size);
        options.type = QueryType::ALL;
        for (int frame = 0; frame < frames; ++frame) {
          engine.update(fibers);
          const QueryResult result = answer(engine, options);
          ASSERT_TRUE(same_contacts(result.contacts, brute_force(fibers, options).contacts))
              << frame;
          found += result.contacts.size();
          move(fibers, motion, random, frame);
        }
        served += frames - engine.refit_count();
      }
    }
  }
  expect_enough<std::size_t>(found, rounds(2500));
  expect_enough<std::uint64_t>(served, rounds(150));
}

/// Loose cables, as a tracker has them or a simulation of yarn.
FiberAssembly loose_cables() {
  Random random(7);
  AssemblyBuilder builder;
  for (int fiber = 0; fiber < 100; ++fiber) {
    builder.add_fiber(random_walk(random, 60, 0.05));
  }
  return builder.build({0.004});
}

/// What all frames of a motion have cost.
struct Cost {
  QueryCounts counts;
  std::uint64_t refits = 0;
  std::vector<double> skins;  // [m] by frame
};

Cost cost_of(const Motion& motion, int frames, const EngineOptions& options) {
  Random random(11);
  FiberAssembly fibers = loose_cables();
  RunTreeEngine engine(options);
  Cost cost;
  for (int frame = 0; frame < frames; ++frame) {
    engine.update(fibers);
    cost.counts += answer(engine, within(0.0)).counts;
    cost.skins.push_back(engine.skin());
    move(fibers, motion, random, frame);
  }
  cost.refits = engine.refit_count();
  return cost;
}

const Motion& named(const std::vector<Motion>& all, const std::string& name) {
  return *std::find_if(all.begin(), all.end(), [&](const Motion& one) { return one.name == name; });
}

TEST(AutomaticSkinTest, FramesThatFollowEachOtherCostLess) {
  for (const std::string name : {"still", "drifting", "trembling", "one of ten is fast"}) {
    SCOPED_TRACE(name);
    const std::vector<Motion> all = motions(1.0);
    const Cost automatic = cost_of(named(all, name), 200, {1});
    const Cost without = cost_of(named(all, name), 200, {1, 0.0});
    EXPECT_LT(automatic.counts.node_tests, without.counts.node_tests / 2);
    EXPECT_EQ(without.refits, 200U);
    if (name != "one of ten is fast") {
      EXPECT_LT(automatic.refits, 70U);
    }
  }
}

TEST(AutomaticSkinTest, WhatDoesNotFollowCostsNextToNothingMore) {
  const std::vector<Motion> all = motions(1.0);
  const Cost automatic = cost_of(named(all, "jumping"), 200, {1});
  const Cost without = cost_of(named(all, "jumping"), 200, {1, 0.0});
  EXPECT_LT(20 * automatic.counts.node_tests, 21 * without.counts.node_tests);
  EXPECT_LT(20 * automatic.counts.primitive_tests, 21 * without.counts.primitive_tests);
}

TEST(AutomaticSkinTest, ASkinIsGivenUpWhereMotionBecomesFastAndTakenUpWhereItIsSlowAgain) {
  const std::vector<Motion> all = motions(1.0);
  const Cost cost = cost_of(named(all, "now and then"), 300, {1});
  for (int begin = 0; begin + 30 <= 300; begin += 30) {
    EXPECT_EQ(cost.skins[begin + 29], 0.0) << begin;  // ten frames of jumps
  }
  int slow_with_a_skin = 0;
  for (int begin = 0; begin + 30 <= 300; begin += 30) {
    slow_with_a_skin += cost.skins[begin + 19] > 0.0 ? 1 : 0;
  }
  EXPECT_GE(slow_with_a_skin, 5);
}

TEST(AutomaticSkinTest, TheSameFramesGiveTheSameSkinsOnAnyNumberOfThreads) {
  const std::vector<Motion> all = motions(1.0);
  for (const Motion& motion : all) {
    SCOPED_TRACE(motion.name);
    const Cost one = cost_of(motion, 40, {1});
    const Cost three = cost_of(motion, 40, {3});
    EXPECT_EQ(one.skins, three.skins);
    EXPECT_EQ(one.counts.node_tests, three.counts.node_tests);
    EXPECT_EQ(one.counts.primitive_tests, three.counts.primitive_tests);
  }
}

}  // namespace
}  // namespace fiber::test
