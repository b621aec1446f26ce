// Between which states there is a motion, and when.
#include "src/ros/detection/fiber_step.hpp"

#include <gtest/gtest.h>

#include "src/ros/support/stamps.hpp"

namespace fiber_proximity_ros {
namespace {

constexpr double longest_motion = 1.0;  // [s]

std::shared_ptr<const FiberMessage> message_of(fiber::FiberAssembly fibers,
                                               std::vector<std::string> names) {
  FiberMessage message;
  message.fibers = std::move(fibers);
  message.names = std::move(names);
  return std::make_shared<const FiberMessage>(std::move(message));
}

/// Two fibres of two inputs.
FiberState state_at(double stamp_a, double stamp_b, double height = 0.0) {
  FiberState state;
  state.has_fibers = true;
  state.message = message_of(
      {{{0, 0, height}, {1, 0, height}, {0, 1, 0}, {1, 1, 0}}, {0, 2, 4}, {0.1}}, {"a", "b"});
  state.stamps = {ros::Time(stamp_a), ros::Time(stamp_b)};
  state.stamp = ros::Time(std::max(stamp_a, stamp_b));
  return state;
}

class FiberStepTest : public testing::Test {
 protected:
  FiberStepTest() { advance(state_at(10.0, 10.0)); }

  void advance(FiberState state) { step_.advance(std::move(state)); }

  void expect_motion(double begin, double end) const {
    EXPECT_TRUE(step_.is_motion());
    EXPECT_EQ(step_.problem(), "");
    EXPECT_EQ(to_stamp(step_.time().lower), ros::Time(begin));
    EXPECT_EQ(to_stamp(step_.time().upper), ros::Time(end));
  }

  void expect_problem(const std::string& problem, double stamp) const {
    EXPECT_FALSE(step_.is_motion());
    EXPECT_EQ(step_.problem(), problem);
    EXPECT_EQ(to_stamp(step_.time().lower), ros::Time(stamp));
    EXPECT_EQ(to_stamp(step_.time().upper), ros::Time(stamp));
  }

  FiberStep step_{longest_motion};
};

TEST_F(FiberStepTest, TheFirstFibersAreNoMotionAndNoProblem) {
  expect_problem("", 10.0);
  EXPECT_EQ(step_.problem_count(), 0U);
}

TEST_F(FiberStepTest, AMotionIsFromWhatWasToWhatIs) {
  advance(state_at(10.5, 10.25, 2.0));
  expect_motion(10.0, 10.5);
  EXPECT_EQ(step_.motion().before.points()[0].z(), 0.0);
  EXPECT_EQ(step_.motion().after.points()[0].z(), 2.0);
}

TEST_F(FiberStepTest, WhatHasSentNothingNewStandsStill) {
  advance(state_at(10.0, 10.25));
  expect_motion(10.0, 10.25);
  advance(state_at(10.5, 10.25));
  expect_motion(10.0, 10.5);
}

TEST_F(FiberStepTest, AnInputWithoutFibersMayComeAndGo) {
  FiberState without = state_at(10.25, 10.0);
  without.stamps.emplace_back(std::nullopt);
  advance(without);
  FiberState with = state_at(10.5, 10.0);
  with.stamps.emplace_back(ros::Time(10.375));
  advance(with);
  expect_motion(10.25, 10.5);
}

TEST_F(FiberStepTest, StampsMustRise) {
  advance(state_at(9.5, 10.0));
  expect_problem("their stamps do not rise", 10.0);
  advance(state_at(9.5, 10.0));
  expect_problem("their stamps do not rise", 10.0);
  EXPECT_EQ(step_.problem_count(), 2U);
  advance(state_at(9.75, 10.0));
  expect_motion(9.5, 9.75);
}

TEST_F(FiberStepTest, StampsMustNotJump) {
  advance(state_at(11.0, 10.0));
  expect_motion(10.0, 11.0);
  advance(state_at(12.5, 10.0));
  expect_problem("their stamps jump by 1.5 s, a motion may take 1 s (input_timeout)", 12.5);
}

TEST_F(FiberStepTest, FibersMustBeTheSame) {
  FiberState renamed = state_at(10.5, 10.0);
  renamed.message = message_of(renamed.message->fibers, {"b", "a"});
  advance(renamed);
  expect_problem("the fibres are no longer the same: 2 of 4 points before, 2 of 4 points now",
                 10.5);
  FiberState longer = state_at(10.75, 10.0);
  longer.message = message_of(
      {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {0, 3, 5}, {0.1}}, {"b", "a"});
  advance(longer);
  expect_problem("the fibres are no longer the same: 2 of 4 points before, 2 of 5 points now",
                 10.75);
}

TEST_F(FiberStepTest, FibersThatWereNotKeptAreNoProblem) {
  FiberState gone = state_at(10.25, 10.0);
  gone.has_fibers = false;
  advance(gone);
  expect_problem("", 10.25);
  advance(state_at(10.5, 10.0));
  expect_problem("", 10.5);
  advance(state_at(10.75, 10.0));
  expect_motion(10.5, 10.75);
}

TEST_F(FiberStepTest, WhatIsRefusedIsOfItsStampAlone) {
  advance(state_at(10.5, 10.0));
  step_.refuse("too far");
  expect_problem("too far", 10.5);
  EXPECT_EQ(step_.problem_count(), 1U);
}

}  // namespace
}  // namespace fiber_proximity_ros
