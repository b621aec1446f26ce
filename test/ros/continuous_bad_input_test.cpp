// The running node with ~continuous: messages between which there is no motion to look at.
#include "test/ros/continuous_fixture.hpp"

namespace {

using namespace continuous_test;  // NOLINT(google-build-using-namespace)

TEST_F(ContinuousTest, OtherFibersAreAnsweredAtTheirStampAlone) {
  FiberArray other = crossed(0.1, -z_);
  other.points.insert(other.points.begin() + 1,
                      fiber_proximity_ros::to_message(Vector3d(-0.4, 0, 0)));
  other.offsets = {0, 6, 8};
  expect_discrete(answer_to(other),
                  "the fibres are no longer the same: 2 of 7 points before, 2 of 8 points now",
                  other);
  FiberArray renamed = other;
  renamed.names = {"across", "along"};
  expect_discrete(answer_to(renamed), "the fibres are no longer the same", renamed);
}

TEST_F(ContinuousTest, AJumpInTimeIsNoMotion) {
  const FiberArray through = crossed(0.1, -z_);
  expect_discrete(answer_to(through, ros::Duration(1001)),
                  "their stamps jump by 1001 s, a motion may take 1000 s (input_timeout)", through);
  const ContactArray* const next = answer_to(crossed(0.1, z_));
  ASSERT_NE(next, nullptr);
  EXPECT_EQ(next->contacts.size(), 1U);
}

TEST_F(ContinuousTest, WaysOfMoreThanCoordinatesMayHaveAreNoMotion) {
  FiberArray far = crossed(0.1, z_);
  far.points.front().x = 1e150;
  far.points.back().x = -1e150;
  ASSERT_NE(answer_to(far), nullptr);
  std::swap(far.points.front().x, far.points.back().x);
  const ros::Time stamp = publish(far);
  expect_discrete(contacts.wait_for(stamp), "fibre 0, segment 0: moves so far", far);
  const TimeToContact* const told = times_.wait_for(stamp);
  ASSERT_NE(told, nullptr);
  EXPECT_NE(told->problem, "") << "they would be beyond all coordinates in a second";
  EXPECT_FALSE(told->same_fiber.expected || told->different_fibers.expected);
  ASSERT_NE(answer_to(crossed(0.1, z_)), nullptr);
}

/// The message is refused: the motion is that from the one before it to the one after.
TEST_F(ContinuousTest, AStateWithoutNumbersIsLeftOut) {
  FiberArray bad = crossed(0.1, 0.0);
  bad.points[2].z = std::numeric_limits<double>::quiet_NaN();
  const ros::Time stamp = publish(bad);
  await_refusal("point 2: z is nan");
  const ContactArray* const answer = answer_to(crossed(0.1, -z_));
  ASSERT_NE(answer, nullptr);
  EXPECT_TRUE(answer->continuous);
  EXPECT_EQ(answer->since, stamp - frame_time);
  ASSERT_EQ(answer->contacts.size(), 1U);
  EXPECT_TRUE(answer->contacts[0].gone);
  EXPECT_NE(refusal_before(*answer).find("point 2: z is nan"), std::string::npos);
  EXPECT_EQ(contacts.find([&](const ContactArray& other) { return other.header.stamp == stamp; }),
            nullptr);
}

TEST_F(ContinuousTest, AnOlderStampIsRefused) {
  const ros::Time stamp = publish(crossed(0.1, -z_), ros::Duration(-1));
  await_refusal("is older than");
  const ContactArray* const answer = answer_to(crossed(0.1, z_), ros::Duration(1.1));
  ASSERT_NE(answer, nullptr);
  EXPECT_NE(refusal_before(*answer).find("is older than"), std::string::npos);
  EXPECT_TRUE(answer->continuous);
  EXPECT_TRUE(answer->contacts.empty()) << "it has not been there";
  EXPECT_EQ(contacts.find([&](const ContactArray& other) { return other.header.stamp == stamp; }),
            nullptr);
}

}  // namespace
