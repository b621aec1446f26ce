#pragma once

#include <string>

#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

namespace node_test {

/// With an input that is all right, beside those that are not.
class BadInputTest : public NodeTest {
 protected:
  void SetUp() override {
    good_ = advertise<fiber_proximity::FiberArray>("good");
    connect(good_, good_message());
  }

  static fiber_proximity::FiberArray good_message() {
    fiber_proximity::FiberArray message =
        test_messages::fiber_array(test_messages::header("world", new_stamp()),
                                   {{0, 0, 0}, {1, 0, 0}, {0, 0.001, 0}, {1, 0.001, 0}});
    message.offsets = {0, 2, 4};
    return message;
  }

  /// A message of one fibre of four points that is all right.
  static fiber_proximity::FiberArray array(const std::string& frame = "world") {
    return test_messages::fiber_array(test_messages::header(frame, new_stamp()), chain());
  }

  static test_messages::Points chain() { return {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}; }

  static sensor_msgs::PointCloud2 cloud(const test_messages::Points& points = chain()) {
    return test_messages::point_cloud2(test_messages::header("world", new_stamp()), points);
  }

  /// Sends the message and expects that it is refused for this reason, with one log entry, without
  /// an answer, and that the node goes on.
  template <class Message>
  void expect_refused(const std::string& topic, const Message& message, const std::string& reason) {
    SCOPED_TRACE(topic);
    const std::size_t answers = contacts.messages.size();
    const std::size_t drawn = fibers.messages.size();
    const ros::Publisher publisher = advertise<Message>("bad/" + topic);
    publisher.publish(message);
    const std::string label = "input 'bad/" + topic + "'";
    ASSERT_TRUE(node_test::wait_for([&] { return !logs_of(label).empty(); })) << "no error";
    EXPECT_NE(logs_of(label).front().find("message refused: " + reason), std::string::npos)
        << logs_of(label).front();

    const fiber_proximity::FiberArray next = good_message();
    good_.publish(next);
    const fiber_proximity::Statistics* now = statistics.wait_for(next.header.stamp);
    ASSERT_NE(now, nullptr) << "the node does not live on";
    const fiber_proximity::InputStatistics* input = input_of(*now, "bad/" + topic);
    ASSERT_NE(input, nullptr);
    EXPECT_EQ(input->received, 1U);
    EXPECT_EQ(input->refused, 1U);
    EXPECT_EQ(input->fibers, 0U);
    EXPECT_EQ(input->last_error.rfind(reason, 0), 0U) << input->last_error;
    EXPECT_EQ(now->fibers, 2U);
    ASSERT_NE(contacts.wait_for(next.header.stamp), nullptr);
    ASSERT_NE(fibers.wait_for(next.header.stamp), nullptr);
    EXPECT_EQ(contacts.messages.size(), answers + 1) << "the bad message was answered";
    EXPECT_EQ(fibers.messages.size(), drawn + 1) << "the bad message was answered";
    EXPECT_EQ(logs_of(label).size(), 1U);
  }

  ros::Publisher good_;
};

}  // namespace node_test
