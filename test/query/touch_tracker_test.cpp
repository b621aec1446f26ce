#include <gtest/gtest.h>

#include <limits>

#include "test/query/touch_tracker_fixture.hpp"

namespace fiber::test {
namespace {

using std::chrono::nanoseconds;

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

/// An object that was put elsewhere is met from where nobody saw it.
TEST_F(TouchTrackerTest, WhatWasThereUnseenAndLeavesBeginsWhenItCame) {
  ASSERT_TRUE(step({}).empty());
  const auto events = step_with({{0, 4, 1, 7, -1e-3, true, at(1000, 1000), at(1200, 1300)}});
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].kind, TouchEvent::Kind::BEGAN);
  EXPECT_EQ(events[0].time.lower, nanoseconds(1000));
  EXPECT_EQ(events[0].time.upper, nanoseconds(1000));
  EXPECT_EQ(events[1].kind, TouchEvent::Kind::ENDED);
  EXPECT_EQ(events[1].time.upper, nanoseconds(1300));
  EXPECT_EQ(events[1].duration(), nanoseconds(300));
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

// Of three places that met within the step, what is left at its end are two touches.
TEST_F(TouchTrackerTest, WhatPartsWithinTheStepThatItBeganInIsTwo) {
  step({});
  std::vector<TouchingPair> pairs;
  for (std::uint32_t i = 0; i < 9; ++i) {
    const bool is_gone = i >= 3 && i < 6;
    pairs.push_back(
        {0, i, 1, i, -1e-3, is_gone, at(1900 + i, 1900 + i), is_gone ? at(1950, 1951) : at(0, 0)});
  }
  const auto began = step_with(pairs);
  ASSERT_EQ(began.size(), 2U);
  EXPECT_EQ(ids_, (std::vector<std::uint64_t>{1, 1, 1, 1, 1, 2, 2, 2, 2}))
      << "what is gone goes with what it was next to";
  EXPECT_EQ(began[0].time.lower, nanoseconds(1900));
  EXPECT_EQ(began[1].time.lower, nanoseconds(1905));
  EXPECT_TRUE(step({{0, 0}, {1, 1}, {2, 2}, {6, 6}, {7, 7}, {8, 8}}).empty())
      << "told when it happened, and not again";
}

TEST_F(TouchTrackerTest, WhatPartsFromALongTouchBeginsWhenItParts) {
  step({{4, 4}, {5, 5}, {6, 6}, {7, 7}, {8, 8}});
  const auto events = step_with({{0, 4, 1, 4, -1e-3, false, at(1000, 1000), {}},
                                 {0, 5, 1, 5, -1e-3, true, at(1000, 1000), at(1600, 1610)},
                                 {0, 6, 1, 6, -1e-3, true, at(1000, 1000), at(1700, 1720)},
                                 {0, 7, 1, 7, -1e-3, false, at(1000, 1000), {}},
                                 {0, 8, 1, 8, -1e-3, false, at(1000, 1000), {}}});
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].kind, TouchEvent::Kind::BEGAN);
  EXPECT_EQ(events[0].touch.id, 2U);
  EXPECT_EQ(events[0].time.lower, nanoseconds(1600));
  EXPECT_EQ(events[0].time.upper, nanoseconds(1720));
  EXPECT_EQ(ids_, (std::vector<std::uint64_t>{1, 1, 2, 2, 2}));
}

TEST_F(TouchTrackerTest, APairThatStaysKeepsItsTouchBeforeOneThatComesNextToIt) {
  step({{9, 9}});
  // Something comes on both sides at smaller indices, and what joined it with the pair is gone.
  const auto events = step_with({{0, 6, 1, 6, -1e-3, false, at(1500, 1500), {}},
                                 {0, 7, 1, 7, -1e-3, true, at(1500, 1500), at(1600, 1600)},
                                 {0, 8, 1, 8, -1e-3, true, at(1500, 1500), at(1600, 1600)},
                                 {0, 9, 1, 9, -1e-3, false, at(1000, 1000), {}}});
  EXPECT_EQ(ids_, (std::vector<std::uint64_t>{2, 2, 1, 1}));
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].touch.id, 2U);
  EXPECT_EQ(events[0].time.lower, nanoseconds(1500));
}

}  // namespace
}  // namespace fiber::test
