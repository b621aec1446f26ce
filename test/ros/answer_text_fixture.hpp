#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <string>
#include <vector>

#include "test/ros/live_settings.hpp"
#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

namespace node_test {

/// Reads the text of the running node about its answers.
class AnswerTextTest : public NodeTest {
 protected:
  void SetUp() override { connect(fibers_publisher_, cables()); }

  /// Three cables side by side.
  static fiber_proximity::FiberArray cables() {
    fiber_proximity::FiberArray message = test_messages::fiber_array(
        test_messages::header("world"),
        {{0, 0, 0}, {1, 0, 0}, {0, 0.0377, 0}, {1, 0.0377, 0}, {0, 1, 0}, {1, 1, 0}});
    message.offsets = {0, 2, 4, 6};
    return message;
  }

  /// Sends the input without which answers about fibres are incomplete.
  void send_rope() {
    set_parameters(shown());
    const ros::Publisher rope = advertise<fiber_proximity::FiberArray>("rope");
    fiber_proximity::FiberArray message =
        test_messages::fiber_array(test_messages::header("world"), {{5, 0, 0}, {5, 1, 0}});
    ASSERT_TRUE(wait_for([&] {
      message.header.stamp = new_stamp();
      rope.publish(message);
      const fiber_proximity::Statistics* const told = statistics.wait_for(message.header.stamp);
      return told != nullptr && told->complete != 0;
    }));
  }

  static fiber_proximity::ProximityConfig shown() {
    fiber_proximity::ProximityConfig config = fiber_proximity::ProximityConfig::__getDefault__();
    config.show_cost = true;
    return config;
  }

  /// The lines of the answer about these fibres. The first two are the marker's, too.
  std::vector<std::string> lines_about(fiber_proximity::FiberArray message) {
    stamp_ = message.header.stamp = new_stamp();
    fibers_publisher_.publish(message);
    const fiber_proximity::Statistics* const told = statistics.wait_for(stamp_);
    const std::string* drawn = nullptr;
    wait_for([&] { return (drawn = drawn_text()) != nullptr; });
    if (told == nullptr || drawn == nullptr) {
      ADD_FAILURE() << "no answer, or none is drawn";
      return {3, ""};
    }
    std::vector<std::string> lines = split(told->summary);
    EXPECT_EQ(lines.size(), 3U) << told->summary;
    lines.resize(3);
    std::vector<std::string> of_marker = split(*drawn);
    of_marker.resize(3);
    EXPECT_EQ(of_marker[0], lines[0]);
    EXPECT_EQ(of_marker[1], lines[1]);
    EXPECT_NE(of_marker[2].find(" ms"), std::string::npos) << of_marker[2];
    EXPECT_EQ(told->parts.size(), told->part_complete.size());
    return lines;
  }

  void forget() {
    drawn_.clear();
    contacts.messages.clear();
    fibers.messages.clear();
    statistics.messages.clear();
  }

  ros::Time stamp_;

 private:
  static std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      lines.push_back(text.substr(begin, end - begin));
      begin = end + 1;
    }
    return lines;
  }

  const std::string* drawn_text() const {
    for (const visualization_msgs::MarkerArray::ConstPtr& message : drawn_) {
      for (const visualization_msgs::Marker& marker : message->markers) {
        if (marker.ns == "cost" && marker.header.stamp == stamp_ &&
            marker.action == visualization_msgs::Marker::ADD) {
          return &marker.text;
        }
      }
    }
    return nullptr;
  }

  ros::Publisher fibers_publisher_ = advertise<fiber_proximity::FiberArray>("fibers");
  std::vector<visualization_msgs::MarkerArray::ConstPtr> drawn_;
  ros::Subscriber markers_ = node.subscribe<visualization_msgs::MarkerArray>(
      "/proximity/markers", 1000, [this](const visualization_msgs::MarkerArray::ConstPtr& message) {
        drawn_.push_back(message);
      });
};

}  // namespace node_test
