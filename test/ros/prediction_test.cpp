// The running node with ~prediction: when fibres will touch if they go on as they do.
#include <limits>

#include "test/ros/continuous_fixture.hpp"

namespace {

using namespace continuous_test;  // NOLINT(google-build-using-namespace)

TEST_F(ContinuousTest, TimeToContactIsThatOfConstantVelocity) {
  // 5 cm per frame towards the cable: half a metre per second.
  for (double z = 0.4; z > 0.21; z -= 0.05) {
    ASSERT_NE(answer_to(crossed(0.1, z)), nullptr);
  }
  const ros::Time stamp = publish(crossed(0.1, 0.2));
  const TimeToContact* const told = times_.wait_for(stamp);
  ASSERT_NE(told, nullptr);
  EXPECT_EQ(told->problem, "");
  EXPECT_EQ(told->horizon, 1.0);
  EXPECT_EQ(told->frames, 3U);
  EXPECT_NEAR(told->frame_time, 0.2, 1e-6);
  EXPECT_FALSE(told->same_fiber.expected);
  EXPECT_EQ(told->same_fiber.time_lower, 1.0);
  const fiber_proximity::PredictedContact& contact = told->different_fibers;
  ASSERT_TRUE(contact.expected);
  EXPECT_TRUE(contact.certain);
  EXPECT_TRUE(contact.complete);
  EXPECT_EQ(contact.touching, 0U);
  EXPECT_EQ(contact.fiber_b, 1U);
  EXPECT_EQ(contact.segment_a, 2U);
  const double expected = (0.2 - 2 * radius) / 0.5;
  EXPECT_LE(contact.time_lower, expected + 1e-7);
  EXPECT_GE(contact.time_upper, expected - 1e-7);
  EXPECT_LT(contact.time_upper - contact.time_lower, 1e-5);

  // Away from it, nothing will be touched.
  ASSERT_NE(answer_to(crossed(0.1, 0.25)), nullptr);
  ASSERT_NE(answer_to(crossed(0.1, 0.3)), nullptr);
  const TimeToContact* const away = times_.wait_for(publish(crossed(0.1, 0.35)));
  ASSERT_NE(away, nullptr);
  EXPECT_FALSE(away->different_fibers.expected);
  EXPECT_EQ(away->different_fibers.time_lower, 1.0);
  EXPECT_EQ(away->different_fibers.time_upper, std::numeric_limits<double>::infinity());

  // What touches already is not predicted.
  ASSERT_NE(answer_to(crossed(0.1, 0.0)), nullptr);
  ASSERT_NE(answer_to(crossed(0.1, 0.0)), nullptr);
  const TimeToContact* const touching = times_.wait_for(publish(crossed(0.1, 0.0)));
  ASSERT_NE(touching, nullptr);
  EXPECT_EQ(touching->different_fibers.touching, 1U);
  EXPECT_FALSE(touching->different_fibers.expected);
}

TEST_F(ContinuousTest, TooFewFramesPredictNothing) {
  FiberArray other = crossed(0.1, z_);
  other.names = {"new", "cables"};
  const TimeToContact* const told = times_.wait_for(publish(other));
  ASSERT_NE(told, nullptr);
  EXPECT_EQ(told->problem, "no input has sent more than one message: there are no velocities yet");
  EXPECT_FALSE(told->different_fibers.expected);
  EXPECT_EQ(times_.wait_for(publish(other))->problem, "");
}

}  // namespace
