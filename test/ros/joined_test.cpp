// Closed and joined fibres through the running node: rings in a FiberArray, rings that a tracker or
// a marker only draws, and a branch.
#include <cmath>

#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

namespace {

using fiber_proximity::ContactArray;
using fiber_proximity::FiberArray;
using test_messages::header;
using test_messages::Points;

constexpr int ring_count = 24;  // points of a ring

/// A ring around the z axis, its first point not repeated.
Points ring(double height) {
  Points points;
  for (int i = 0; i < ring_count; ++i) {
    const double angle = 2.0 * M_PI * i / ring_count;
    points.emplace_back(0.1 * std::cos(angle), 0.1 * std::sin(angle), height);
  }
  return points;
}

Points drawn_ring(double height) {
  Points points = ring(height);
  points.push_back(points.front());
  return points;
}

class JoinedTest : public node_test::NodeTest {
 protected:
  /// What the node answers about so many fibres, to the message of this stamp.
  const ContactArray* answer(const ros::Time& stamp, std::size_t fiber_count) {
    return contacts.wait_for([&](const ContactArray& answer) {
      return answer.header.stamp == stamp && answer.fiber_names.size() == fiber_count;
    });
  }

  /// A ring that a FiberArray calls closed, with a branch at its fifth point.
  static FiberArray ring_with_branch() {
    FiberArray message = test_messages::fiber_array(header("world"), ring(0.0));
    for (int i = 0; i < 6; ++i) {
      const double distance = 0.1 + 0.02 * i;
      const double angle = 2.0 * M_PI * 5 / ring_count;
      message.points.push_back(fiber_proximity_ros::to_message(
          Eigen::Vector3d(distance * std::cos(angle), distance * std::sin(angle), 0.0)));
    }
    message.offsets.push_back(ring_count + 6);
    message.radii = {0.005};
    message.names = {"ring", "branch"};
    message.closed = {1, 0};
    message.joints.assign(ring_count + 6, -1);
    message.joints[5] = message.joints[ring_count] = 17;
    return message;
  }

  ros::Publisher told_ = advertise<FiberArray>("/told");
  ros::Publisher drawn_ = advertise<geometry_msgs::PoseArray>("/drawn");
  ros::Publisher open_ = advertise<geometry_msgs::PoseArray>("/open");
};

TEST_F(JoinedTest, RingsAndBranchesDoNotTouchWhereTheyAreJoined) {
  FiberArray told = ring_with_branch();
  told.header.stamp = new_stamp();
  told_.publish(told);
  const ContactArray* found = answer(told.header.stamp, 2);
  ASSERT_NE(found, nullptr);
  EXPECT_TRUE(found->contacts.empty());
  EXPECT_FALSE(found->has_minimum) << "no pair is a pair";
  const FiberArray* shown = fibers.wait_for(told.header.stamp);
  ASSERT_NE(shown, nullptr);
  EXPECT_EQ(shown->closed, told.closed);
  EXPECT_EQ(shown->joints, told.joints);
  EXPECT_EQ(shown->points.size(), told.points.size());

  ros::Time stamp = new_stamp();
  drawn_.publish(test_messages::pose_array(header("world", stamp), drawn_ring(1.0)));
  found = answer(stamp, 3);
  ASSERT_NE(found, nullptr);
  EXPECT_TRUE(found->contacts.empty());
  shown = fibers.wait_for(stamp);
  ASSERT_NE(shown, nullptr);
  EXPECT_EQ(shown->closed, (std::vector<std::uint8_t>{1, 0, 1}));

  // Nobody says of this one that it is a ring: its ends touch.
  stamp = new_stamp();
  open_.publish(test_messages::pose_array(header("world", stamp), drawn_ring(2.0)));
  found = answer(stamp, 4);
  ASSERT_NE(found, nullptr);
  ASSERT_FALSE(found->contacts.empty());
  for (const fiber_proximity::Contact& contact : found->contacts) {
    EXPECT_EQ(contact.fiber_a, 3U);
    EXPECT_EQ(contact.fiber_b, 3U);
  }

  // What is not joined touches as ever, the closing segment too.
  told = ring_with_branch();
  told.header.stamp = new_stamp();
  for (int i = 1; i < 6; ++i) {  // the branch turns to the seam
    told.points[static_cast<std::size_t>(ring_count + i)].x = 0.1 + 0.012 * (5 - i) + 0.004;
    told.points[static_cast<std::size_t>(ring_count + i)].y = -0.013;
    told.points[static_cast<std::size_t>(ring_count + i)].z = 0.012 * (5 - i) + 0.004;
  }
  told_.publish(told);
  found = answer(told.header.stamp, 4);
  ASSERT_NE(found, nullptr);
  const bool touches = std::any_of(
      found->contacts.begin(), found->contacts.end(), [](const fiber_proximity::Contact& contact) {
        return contact.fiber_a == 0 && contact.fiber_b == 1 && contact.segment_a == ring_count - 1;
      });
  EXPECT_TRUE(touches);
}

TEST_F(JoinedTest, WhatDoesNotMeetIsRefusedByItsPlace) {
  FiberArray told = ring_with_branch();
  told.header.stamp = new_stamp();
  told.points[ring_count].z = 0.3;
  told_.publish(told);
  expect_log("joint 17: fibre 0, point 5 and fibre 1, point 0 are 0.3 m apart");

  told = ring_with_branch();
  told.header.stamp = new_stamp();
  told.closed = {1};
  told_.publish(told);
  expect_log("closed has 1 value(s) for 2 fibre(s)");

  told = ring_with_branch();
  told.header.stamp = new_stamp();
  told.closed = {};
  told.joints[ring_count] = -1;
  told_.publish(told);
  expect_log("joint 17 is the number of point 5 alone: it joins nothing");

  told = ring_with_branch();
  told.header.stamp = new_stamp();
  told.joints.pop_back();
  told_.publish(told);
  expect_log("joints has 29 value(s) for 30 points");
}

}  // namespace
