#include "src/ros/inputs/publishers.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace fiber_proximity_ros {
namespace {

TEST(SequenceGaps, WhatIsMissingBetweenNumbersIsCounted) {
  SequenceGaps gaps;
  EXPECT_EQ(gaps.count(), -1) << "nothing is known yet";
  gaps.add("/a", 0);
  EXPECT_EQ(gaps.count(), -1);
  gaps.add("/a", 1);
  EXPECT_EQ(gaps.count(), 0);
  gaps.add("/a", 4);
  EXPECT_EQ(gaps.count(), 2);
  gaps.add("/a", 5);
  EXPECT_EQ(gaps.count(), 2);
}

TEST(SequenceGaps, WhatWasSentBeforeTheFirstIsNotMissing) {
  SequenceGaps gaps;
  gaps.add("/a", 1000);
  EXPECT_EQ(gaps.count(), 0);
}

TEST(SequenceGaps, EveryPublisherHasItsOwnNumbers) {
  SequenceGaps gaps;
  for (std::uint32_t i = 0; i < 10; ++i) {
    gaps.add("/a", i);
    gaps.add("/b", 1000 + 2 * i);
  }
  EXPECT_EQ(gaps.count(), 9);
}

TEST(SequenceGaps, APublisherThatStartsAgainHasLostNothing) {
  SequenceGaps gaps;
  gaps.add("/a", 500);
  gaps.add("/a", 0);
  gaps.add("/a", 1);
  EXPECT_EQ(gaps.count(), 0);
  gaps.add("/a", std::numeric_limits<std::uint32_t>::max());
  gaps.add("/a", 0);  // the numbers are used up
  EXPECT_EQ(gaps.count(), 4'294'967'293);
}

TEST(SequenceGaps, WithoutNumbersNothingIsKnown) {
  SequenceGaps gaps;
  for (int i = 0; i < 10; ++i) {
    gaps.add("/a", 0);
  }
  EXPECT_EQ(gaps.count(), -1);
}

TEST(SequenceGaps, ManyPublishersThatComeAndGoLeaveTheOthersCounted) {
  SequenceGaps gaps;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    gaps.add("/once_" + std::to_string(i), i);
    gaps.add("/a", 2 * i);
  }
  EXPECT_EQ(gaps.count(), 999);
}

TEST(PublisherTurns, AreTwoThatComeBack) {
  PublisherTurns turns;
  EXPECT_EQ(turns.add("/a"), "");
  EXPECT_EQ(turns.add("/a"), "");
  EXPECT_EQ(turns.add("/b"), "") << "it has taken over";
  EXPECT_EQ(turns.add("/b"), "");
  EXPECT_EQ(turns.add("/a"), "/b");
  EXPECT_EQ(turns.add("/b"), "/a");
  EXPECT_EQ(turns.add("/c"), "");
  EXPECT_EQ(turns.add("/d"), "");
}

TEST(Publishers, AreWarnedOfInTheSameWordsWhicheverComesBack) {
  Publishers publishers;
  EXPECT_EQ(publishers.add("b", 1), "");
  EXPECT_EQ(publishers.add("a", std::nullopt), "");
  const std::string warning = publishers.add("b", 3);
  EXPECT_NE(warning.find("'a' and 'b' by turns"), std::string::npos) << warning;
  EXPECT_EQ(publishers.add("a", std::nullopt), warning);
  EXPECT_EQ(publishers.lost_messages(), 1);
}

}  // namespace
}  // namespace fiber_proximity_ros
