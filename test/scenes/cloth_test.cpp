#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "fiber_proximity/query/engine.hpp"
#include "src/scenes/scenes.hpp"
#include "test/support/hash.hpp"

namespace fiber {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

/// Pairs of yarns that touch; of each, whether the first is over the second.
std::set<std::pair<Pair, bool>> touching(const FiberAssembly& fibers) {
  const auto engine = make_engine("run_tree");
  engine->update(fibers);
  QueryResult result;
  engine->query({}, result);
  std::set<std::pair<Pair, bool>> pairs;
  for (const Contact& contact : result.contacts) {
    pairs.insert({{contact.fiber_a, contact.fiber_b}, contact.normal.z() < 0.0});
  }
  return pairs;
}

TEST(Cloth, EveryWarpCrossesEveryWeftOverAndUnderInTurn) {
  for (const std::uint32_t count : {40U, 41U}) {
    for (const std::uint32_t frame : {0U, 30U}) {
      const FiberAssembly fibers = cloth({count / 500.0, 1}, frame);
      ASSERT_EQ(fibers.fiber_count(), count);
      const std::uint32_t warp = count - count / 2;
      std::set<std::pair<Pair, bool>> expected;
      for (std::uint32_t i = 0; i < warp; ++i) {
        for (std::uint32_t j = 0; j < count / 2; ++j) {
          expected.insert({{i, warp + j}, (i + j) % 2 == 0});
        }
      }
      EXPECT_EQ(touching(fibers), expected) << count << ", frame " << frame;
    }
  }
}

TEST(Cloth, AtFullScaleTooEveryCrossingTouches) {
  const FiberAssembly fibers = cloth({1.0, 1}, 10);
  EXPECT_EQ(touching(fibers).size(), 250U * 250U);
}

TEST(Cloth, MovesSmoothly) {
  FiberAssembly before = cloth({0.02, 1}, 0);
  const FiberAssembly first = before;
  for (std::uint32_t frame = 1; frame <= 100; ++frame) {
    FiberAssembly now = cloth({0.02, 1}, frame);
    for (std::size_t i = 0; i < now.point_count(); ++i) {
      // The steepest slope of the wave is 2π amplitudes per period.
      ASSERT_LE((now.points()[i] - before.points()[i]).norm(), 0.004 * 2.0 * M_PI / 100.0);
    }
    before = std::move(now);
  }
  EXPECT_EQ(before.points(), first.points());
}

TEST(Cloth, OneYarnIsACloth) { EXPECT_EQ(cloth({1e-9, 1}, 0).fiber_count(), 1U); }

// When the cloth changes on purpose, take the new values from this test's output.
TEST(Cloth, IsTheSameBitsOnEveryMachine) {
  EXPECT_EQ(test::hash(cloth({0.02, 1}, 0)), 11205678530232366703U);
  EXPECT_EQ(test::hash(cloth({0.02, 1}, 42)), 890933536763513687U);
}

}  // namespace
}  // namespace fiber
