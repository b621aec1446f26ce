#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <utility>

#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/scenes/scene.hpp"
#include "src/scenes/scenes.hpp"

namespace fiber {
namespace {

constexpr std::uint32_t frames = 360;  // one period

TEST(Cables, RepeatAfterAPeriod) {
  const FiberAssembly first = cables(1.25);
  const FiberAssembly again = cables(1.25 + cables_period);
  ASSERT_EQ(first.fiber_count(), 5U);
  for (std::size_t i = 0; i < first.point_count(); ++i) {
    EXPECT_LT((first.points()[i] - again.points()[i]).norm(), 1e-12);
  }
}

TEST(Cables, MoveSmoothlyAboveTheGround) {
  FiberAssembly before = cables({}, 0);
  double farthest = 0.0;
  double lowest = 1.0;
  for (std::uint32_t frame = 1; frame <= frames; ++frame) {
    FiberAssembly now = cables({}, frame);
    ASSERT_EQ(now.offsets(), before.offsets());
    for (std::uint32_t i = 0; i < now.point_count(); ++i) {
      farthest = std::max(farthest, (now.points()[i] - before.points()[i]).norm());
      lowest = std::min(lowest, now.points()[i].z());
    }
    before = std::move(now);
  }
  EXPECT_GT(farthest, 1e-4);
  EXPECT_LT(farthest, 0.01);
  EXPECT_GT(lowest, 0.0);
}

TEST(Cables, ContactsComeAndGo) {
  struct Meeting {
    std::uint32_t frames = 0;
    double deepest = 0.0;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Meeting> meetings;
  const auto engine = make_engine("run_tree");
  QueryOptions options;
  options.neighbour_skip_length = 0.05;
  QueryResult result;
  for (std::uint32_t frame = 0; frame < frames; ++frame) {
    const FiberAssembly fibers = cables({}, frame);
    engine->update(fibers);
    engine->query(options, result);
    std::map<std::pair<std::uint32_t, std::uint32_t>, bool> seen;
    for (const Contact& contact : result.contacts) {
      Meeting& meeting = meetings[{contact.fiber_a, contact.fiber_b}];
      meeting.frames += seen.emplace(std::pair(contact.fiber_a, contact.fiber_b), true).second;
      meeting.deepest = std::min(meeting.deepest, contact.distance);
    }
  }
  for (const auto& [pair, meeting] : meetings) {
    SCOPED_TRACE(testing::Message() << "fibres " << pair.first << " and " << pair.second);
    EXPECT_LT(meeting.frames, frames);
    EXPECT_GT(meeting.deepest, -0.004);
  }
  EXPECT_GE(meetings.size(), 4U);
  EXPECT_EQ(meetings.count({3, 3}), 1U);  // the loop with itself
}

TEST(Cables, AreASceneOfAtMostFive) {
  EXPECT_EQ(make_scene("cables", {})(30).points(), cables(1.0).points());
  const FiberAssembly three = make_scene("cables", {0.6, 1})(30);
  ASSERT_EQ(three.fiber_count(), 3U);
  EXPECT_EQ(three.radii(), (std::vector<double>{0.010, 0.007, 0.005}));
  EXPECT_EQ(three.points().back(), cables(1.0).points()[three.point_count() - 1]);
  EXPECT_THROW(make_scene("cables", {2.0, 1})(0), std::invalid_argument);
}

}  // namespace
}  // namespace fiber
