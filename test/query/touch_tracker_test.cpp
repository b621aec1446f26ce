#include "src/query/touch_tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

using std::chrono::nanoseconds;

TimeBounds at(std::int64_t lower, std::int64_t upper) {
  return {nanoseconds(lower), nanoseconds(upper)};
}

/// Steps are 1000 ns long, the first ends at 1000.
class TouchTrackerTest : public testing::Test {
 protected:
  struct Segments {
    std::uint32_t a;
    std::uint32_t b;
  };

  /// Pairs of segments of fibres 0 and 1.
  std::vector<TouchEvent> step(const std::vector<Segments>& segments) {
    std::vector<TouchingPair> pairs;
    for (const Segments& pair : segments) {
      pairs.push_back({0, pair.a, 1, pair.b, -1e-3, false, step_, {}});
    }
    return step_with(pairs);
  }

  std::vector<TouchEvent> step_with(const std::vector<TouchingPair>& pairs) {
    std::vector<TouchEvent> events;
    tracker_.advance(pairs, step_, events);
    ids_.clear();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      ids_.push_back(tracker_.touch_of(i).id);
    }
    step_ = {step_.upper, step_.upper + nanoseconds(1000)};
    return events;
  }

  TouchTracker tracker_;
  TimeBounds step_ = at(0, 1000);
  std::vector<std::uint64_t> ids_;  // of the last step's pairs
};

TEST_F(TouchTrackerTest, ATouchBeginsLastsAndEnds) {
  EXPECT_TRUE(step({}).empty());
  const auto began = step({{4, 7}});
  ASSERT_EQ(began.size(), 1U);
  EXPECT_EQ(began[0].kind, TouchEvent::Kind::BEGAN);
  EXPECT_EQ(began[0].touch.id, 1U);
  EXPECT_EQ(began[0].touch.pair.segment_a, 4U);
  EXPECT_EQ(began[0].touch.pair.segment_b, 7U);
  EXPECT_EQ(began[0].time.lower, nanoseconds(1000));
  EXPECT_EQ(began[0].time.upper, nanoseconds(2000));
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(step({{4, 7}}).empty());
    EXPECT_EQ(ids_, std::vector<std::uint64_t>{1});
  }
  const auto ended = step({});
  ASSERT_EQ(ended.size(), 1U);
  EXPECT_EQ(ended[0].kind, TouchEvent::Kind::ENDED);
  EXPECT_EQ(ended[0].touch.id, 1U);
  EXPECT_EQ(ended[0].time.lower, nanoseconds(7000));
  EXPECT_EQ(ended[0].duration(), nanoseconds(7000));
  EXPECT_EQ(step({{4, 7}}).front().touch.id, 2U);
}

TEST_F(TouchTrackerTest, ATouchThatSlidesAlongStaysTheSame) {
  ASSERT_EQ(step({{0, 0}}).size(), 1U);
  for (std::uint32_t i = 1; i < 50; ++i) {
    EXPECT_TRUE(step({{i - 1, i / 2}, {i, i / 2}}).empty());  // at a joint
    EXPECT_EQ(ids_, (std::vector<std::uint64_t>{1, 1}));
    EXPECT_TRUE(step({{i, i / 2}}).empty());
  }
  for (std::uint32_t i = 49; i > 0; --i) {
    EXPECT_TRUE(step({{i - 1, (i - 1) / 2}}).empty()) << "and back";
    EXPECT_EQ(ids_, std::vector<std::uint64_t>{1});
  }
  EXPECT_EQ(step({{3, 0}}).size(), 2U) << "three segments on, it is another one";
}

TEST_F(TouchTrackerTest, TouchesFarFromEachOtherAreTwo) {
  EXPECT_EQ(step({{4, 7}, {4, 9}, {9, 7}}).size(), 3U);
  EXPECT_EQ(ids_, (std::vector<std::uint64_t>{1, 2, 3}));
  const auto ended = step({{4, 9}});
  ASSERT_EQ(ended.size(), 2U);
  EXPECT_EQ(ended[0].touch.id, 1U);
  EXPECT_EQ(ended[1].touch.id, 3U);
  EXPECT_EQ(ids_, std::vector<std::uint64_t>{2});
}

TEST_F(TouchTrackerTest, WhereTouchesMeetTheOlderGoesOn) {
  step({{9, 9}});
  step({{4, 4}, {9, 9}});
  EXPECT_EQ(ids_, (std::vector<std::uint64_t>{2, 1}));
  const auto events = step({{4, 4}, {5, 5}, {6, 6}, {7, 7}, {8, 8}, {9, 9}});
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].kind, TouchEvent::Kind::ENDED);
  EXPECT_EQ(events[0].touch.id, 2U);
  EXPECT_EQ(std::set<std::uint64_t>(ids_.begin(), ids_.end()), std::set<std::uint64_t>{1});
  const auto parted = step({{4, 4}, {9, 9}});
  ASSERT_EQ(parted.size(), 1U);
  EXPECT_EQ(parted[0].kind, TouchEvent::Kind::BEGAN);
  EXPECT_EQ(ids_, (std::vector<std::uint64_t>{1, 3}));
}

TEST_F(TouchTrackerTest, WhatBeginsAndEndsInOneStepIsTold) {
  step({});
  const auto events = step_with({{0, 3, 1, 5, -2e-3, true, at(1200, 1210), at(1700, 1710)},
                                 {0, 4, 1, 5, -5e-3, true, at(1100, 1220), at(1600, 1720)}});
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].kind, TouchEvent::Kind::BEGAN);
  EXPECT_EQ(events[0].time.lower, nanoseconds(1100));
  EXPECT_EQ(events[0].time.upper, nanoseconds(1210)) << "one of the two had begun by then";
  EXPECT_EQ(events[1].kind, TouchEvent::Kind::ENDED);
  EXPECT_EQ(events[1].time.lower, nanoseconds(1700)) << "one of the two was there until then";
  EXPECT_EQ(events[1].time.upper, nanoseconds(1720));
  EXPECT_EQ(events[1].duration(), nanoseconds(620));
  EXPECT_EQ(events[1].touch.deepest, -5e-3);
  EXPECT_EQ(events[1].touch.pair.segment_a, 4U) << "the deeper one";
  EXPECT_TRUE(step({}).empty()) << "it ended once";
}

TEST_F(TouchTrackerTest, WhatIsGoneHereButThereNextDoorLasts) {
  step({{3, 5}});
  const auto events = step_with({{0, 3, 1, 5, -1e-3, true, at(1000, 1000), at(1300, 1310)},
                                 {0, 4, 1, 5, -1e-3, false, at(1290, 1300), {}}});
  EXPECT_TRUE(events.empty());
  EXPECT_EQ(ids_, (std::vector<std::uint64_t>{1, 1}));
}

TEST_F(TouchTrackerTest, FibersKeepTheirTouchesUnderOtherIndices) {
  std::vector<TouchEvent> events;
  tracker_.advance({{0, 3, 1, 5, -1e-3, false, step_, {}},
                    {0, 8, 2, 5, -1e-3, false, step_, {}},
                    {1, 1, 2, 2, -1e-3, false, step_, {}}},
                   step_, events);
  ASSERT_EQ(events.size(), 3U);
  events.clear();
  tracker_.renumber({1, std::nullopt, 0}, at(1000, 1500), events);
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].touch.id, 1U);
  EXPECT_EQ(events[1].touch.id, 3U);
  EXPECT_EQ(events[1].time.upper, nanoseconds(1500));
  events.clear();
  tracker_.advance({{0, 5, 1, 8, -1e-3, false, step_, {}}}, step_, events);
  EXPECT_TRUE(events.empty());
  EXPECT_EQ(tracker_.touch_of(0).id, 2U);
}

TEST_F(TouchTrackerTest, ForgettingEndsNothing) {
  step({{3, 5}});
  tracker_.forget();
  const auto events = step({{3, 5}});
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].kind, TouchEvent::Kind::BEGAN);
  EXPECT_EQ(events[0].touch.id, 2U);
}

/// Against patches that are grown by looking at all pairs, over random steps; that every touch
/// begins once, ends once, and is there in between.
TEST_F(TouchTrackerTest, PatchesAreThoseOfAllPairs) {
  Random random;
  std::map<std::uint64_t, bool> open;
  std::size_t ended = 0;
  for (int round = 0; round < rounds(300); ++round) {
    // Of a few fibres: the last segment of one is no neighbour of the first of the next.
    std::set<std::array<std::uint32_t, 4>> drawn;
    const auto count = random.integer(0, 60);
    for (std::int64_t i = 0; i < count; ++i) {
      drawn.insert({static_cast<std::uint32_t>(random.integer(0, 1)),
                    static_cast<std::uint32_t>(random.integer(0, 11)),
                    static_cast<std::uint32_t>(random.integer(1, 2)),
                    static_cast<std::uint32_t>(random.integer(0, 11))});
    }
    std::vector<TouchingPair> pairs;
    for (const auto& [fiber_a, a, fiber_b, b] : drawn) {
      pairs.push_back({fiber_a, a, fiber_b, b, -1e-3, false, step_, {}});
    }
    for (const TouchEvent& event : step_with(pairs)) {
      if (event.kind == TouchEvent::Kind::BEGAN) {
        EXPECT_TRUE(open.emplace(event.touch.id, true).second);
      } else {
        EXPECT_EQ(open.erase(event.touch.id), 1U);
        ++ended;
      }
    }
    std::vector<std::size_t> patch(pairs.size());
    for (std::size_t i = 0; i < patch.size(); ++i) {
      patch[i] = i;
    }
    const auto apart = [](std::uint32_t x, std::uint32_t y) { return x < y ? y - x : x - y; };
    for (std::size_t again = 0; again < pairs.size(); ++again) {
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        for (std::size_t j = 0; j < pairs.size(); ++j) {
          if (pairs[i].fiber_a == pairs[j].fiber_a && pairs[i].fiber_b == pairs[j].fiber_b &&
              apart(pairs[i].segment_a, pairs[j].segment_a) <= 1 &&
              apart(pairs[i].segment_b, pairs[j].segment_b) <= 1) {
            patch[i] = std::min(patch[i], patch[j]);
          }
        }
      }
    }
    std::set<std::uint64_t> there;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      there.insert(ids_[i]);
      for (std::size_t j = 0; j < i; ++j) {
        ASSERT_EQ(ids_[i] == ids_[j], patch[i] == patch[j]);
      }
    }
    ASSERT_EQ(there.size(), open.size());
    for (const std::uint64_t id : there) {
      ASSERT_EQ(open.count(id), 1U);
    }
  }
  expect_enough(ended, static_cast<std::size_t>(rounds(500)));
}

}  // namespace
}  // namespace fiber::test
