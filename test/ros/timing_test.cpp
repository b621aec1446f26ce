// Messages that come faster than transforms, or than the node can answer.
#include <tf2_msgs/TFMessage.h>

#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

namespace {

using fiber_proximity::FiberArray;
using test_messages::header;
using test_messages::Points;

class TimingTest : public node_test::NodeTest {
 protected:
  void SetUp() override {
    probe_ = advertise<FiberArray>("probe");
    connect(probe_, test_messages::fiber_array(header("world"), {{0, 0, 0}, {1, 0, 0}}));
  }

  /// Returns what the node says about its input `late` after it has handled what came before.
  fiber_proximity::InputStatistics late_input() {
    const ros::Time stamp = new_stamp();
    probe_.publish(test_messages::fiber_array(header("world", stamp), {{0, 0, 0}, {1, 0, 0}}));
    const fiber_proximity::Statistics* now = statistics.wait_for(stamp);
    return now == nullptr ? fiber_proximity::InputStatistics() : *input_of(*now, "late");
  }

  void send_transform(const ros::Publisher& tf, const ros::Time& stamp, double x) const {
    tf2_msgs::TFMessage message;
    message.transforms.resize(1);
    message.transforms[0].header = header("world", stamp);
    message.transforms[0].child_frame_id = "slow";
    message.transforms[0].transform.translation.x = x;
    message.transforms[0].transform.rotation.w = 1.0;
    tf.publish(message);
  }

  /// Brute force takes far longer for one of these than sending many.
  static Points long_chain() {
    Points points(3000);
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] = {static_cast<double>(i), 0.0, 0.0};
    }
    return points;
  }

  ros::Publisher probe_;
};

TEST_F(TimingTest, AMessageKeepsItsTurnWhileNewerOnesReplaceTheOneBehindIt) {
  const ros::Publisher late = advertise<FiberArray>("late");
  const ros::Publisher tf = advertise<tf2_msgs::TFMessage>("/tf");
  std::vector<ros::Time> stamps;
  for (std::uint64_t i = 1; i <= 3; ++i) {
    stamps.push_back(new_stamp());
    late.publish(test_messages::fiber_array(header("slow", stamps.back()), {{0, 0, 0}, {0, 1, 0}}));
    ASSERT_TRUE(node_test::wait_for([&] { return late_input().received == i; }));
  }
  EXPECT_EQ(late_input().overtaken, 1U);  // the second, by the third
  EXPECT_EQ(late_input().fibers, 0U);

  // The first one's transform: the first one is answered. The fibres of `late` stand first.
  const auto is_placed_at = [](double x) {
    return [x](const FiberArray& message) {
      return message.names == std::vector<std::string>{"late", "probe"} && message.points[0].x == x;
    };
  };
  send_transform(tf, stamps[0], 10.0);
  EXPECT_NE(fibers.wait_for(is_placed_at(10.0)), nullptr);
  EXPECT_EQ(late_input().overtaken, 1U);

  // The third one's: the third one is, and nothing is left.
  send_transform(tf, stamps[2], 30.0);
  EXPECT_NE(fibers.wait_for(is_placed_at(30.0)), nullptr);
  const fiber_proximity::InputStatistics input = late_input();
  EXPECT_EQ(input.received, 3U);
  EXPECT_EQ(input.overtaken, 1U);
  EXPECT_EQ(input.refused, 0U);
}

TEST_F(TimingTest, MessagesThatArriveTogetherAreAnsweredTogether) {
  const ros::Publisher late = advertise<FiberArray>("late");
  // While contacts of many fibres are looked for, two messages arrive: on a busy machine not
  // always. Whoever answers one by one never does otherwise.
  ASSERT_TRUE(node_test::wait_for([&] {
    const std::uint32_t before = contacts.messages.back()->header.seq;
    const FiberArray heavy = test_messages::fiber_array(header("world", new_stamp()), long_chain());
    const FiberArray first =
        test_messages::fiber_array(header("world", new_stamp()), {{0, 0, 0}, {0, 1, 0}});
    const FiberArray second =
        test_messages::fiber_array(header("world", new_stamp()), {{0, 0, 0}, {0, 2, 0}});
    probe_.publish(heavy);
    // Fibres go out before contacts are looked for.
    if (fibers.wait_for(heavy.header.stamp) == nullptr) {
      return false;
    }
    late.publish(first);
    probe_.publish(second);
    const auto is_merged = [&](const FiberArray& message) {
      return message.header.stamp == second.header.stamp && message.points.size() == 4 &&
             message.points[1].y == 1.0 && message.points[3].y == 2.0;
    };
    const fiber_proximity::ContactArray* answer = contacts.wait_for(second.header.stamp);
    // Published answers are numbered, even those that were overtaken on their way here.
    return fibers.wait_for(is_merged) != nullptr && answer != nullptr &&
           answer->header.seq - before <= 2U;
  })) << "the messages were answered one by one";
}

TEST_F(TimingTest, WhatIsDroppedOnTheWayIsCounted) {
  const auto probe_input = [this] {
    late_input();
    return *input_of(*statistics.messages.back(), "probe");
  };
  constexpr std::uint64_t burst = 200;
  const fiber_proximity::InputStatistics before = probe_input();
  FiberArray message = test_messages::fiber_array(header("world"), long_chain());
  for (std::uint64_t i = 0; i < burst; ++i) {
    message.header.stamp = new_stamp();
    probe_.publish(message);
  }
  ASSERT_NE(contacts.wait_for(message.header.stamp), nullptr);
  const fiber_proximity::InputStatistics now = probe_input();
  const std::uint64_t received = now.received - before.received;
  EXPECT_LT(received, burst) << "nothing was dropped, so nothing is tested";
  EXPECT_EQ(received + static_cast<std::uint64_t>(now.dropped - before.dropped), burst + 1);
}

TEST_F(TimingTest, ABurstIsAnsweredWithItsNewestMessageAndNothingQueuesUp) {
  constexpr std::size_t burst = 30;
  FiberArray message = test_messages::fiber_array(header("world"), long_chain());
  const std::size_t before = contacts.messages.size();
  for (std::size_t i = 0; i < burst; ++i) {
    message.header.stamp = new_stamp();
    probe_.publish(message);
  }
  ASSERT_NE(contacts.wait_for(message.header.stamp), nullptr);
  EXPECT_LT(contacts.messages.size() - before, burst / 2) << "every message was answered";
  for (std::size_t i = 1; i < contacts.messages.size(); ++i) {
    EXPECT_LT(contacts.messages[i - 1]->header.stamp, contacts.messages[i]->header.stamp);
  }
}

}  // namespace
