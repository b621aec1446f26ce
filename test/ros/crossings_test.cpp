// ~crossings of the running node, and what it draws of them.
#include <tf2_ros/static_transform_broadcaster.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstdio>
#include <cstdlib>

#include "fiber_proximity/CrossingArray.h"
#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

namespace {

using fiber_proximity::Crossing;
using fiber_proximity::CrossingArray;
using fiber_proximity_ros::to_vector;

/// b, along y, passes 0.5 above the second segment of a, along x.
fiber_proximity::FiberArray cross() {
  fiber_proximity::FiberArray message = test_messages::fiber_array(
      test_messages::header("world"),
      {{-2, 0, 0}, {-1, 0, 0}, {1, 0, 0}, {0.5, -1, 0.5}, {0.5, 3, 0.5}});
  message.offsets = {0, 3, 5};
  message.radii = {0.125};
  message.names = {"a", "b"};
  return message;
}

void expect_cross(const CrossingArray& answer, bool a_is_over) {
  EXPECT_EQ(answer.header.frame_id, "world");
  EXPECT_EQ(answer.fiber_names, (std::vector<std::string>{"a", "b"}));
  ASSERT_EQ(answer.crossings.size(), 1U);
  const Crossing& crossing = answer.crossings[0];
  EXPECT_EQ(crossing.fiber_a, 0U);
  EXPECT_EQ(crossing.segment_a, 1U);
  EXPECT_EQ(crossing.s, 0.75);
  EXPECT_EQ(crossing.fiber_b, 1U);
  EXPECT_EQ(crossing.segment_b, 0U);
  EXPECT_EQ(crossing.t, 0.25);
  EXPECT_EQ(crossing.a_is_over, a_is_over);
  EXPECT_EQ(crossing.sign, -1);
  EXPECT_EQ(crossing.separation, 0.5);
  EXPECT_EQ(crossing.gap, 0.25);
  EXPECT_EQ(to_vector(crossing.point_a), Eigen::Vector3d(0.5, 0, 0));
  EXPECT_EQ(to_vector(crossing.point_b), Eigen::Vector3d(0.5, 0, 0.5));
}

class CrossingsTest : public node_test::NodeTest {
 protected:
  const CrossingArray* answer_to(const ros::Publisher& publisher,
                                 fiber_proximity::FiberArray message) {
    message.header.stamp = new_stamp();
    publisher.publish(message);
    return crossings.wait_for(message.header.stamp);
  }

  node_test::Recorder<CrossingArray> crossings{node, "/proximity/crossings"};
};
using CrossingsCameraTest = CrossingsTest;

TEST_F(CrossingsTest, AreSeenFromAboveByDefault) {
  const ros::Publisher publisher = advertise<fiber_proximity::FiberArray>("fibers");
  connect(publisher, cross(), [&] { return !crossings.messages.empty(); });
  const CrossingArray* answer = answer_to(publisher, cross());
  ASSERT_NE(answer, nullptr);
  EXPECT_FALSE(answer->is_perspective);
  EXPECT_EQ(to_vector(answer->direction), Eigen::Vector3d(0, 0, -1));
  expect_cross(*answer, false);
  answer = answer_to(publisher, test_messages::fiber_array(test_messages::header("world"),
                                                           {{0, 0, 0}, {1, 0, 0}}));
  ASSERT_NE(answer, nullptr);
  EXPECT_TRUE(answer->crossings.empty());
}

TEST_F(CrossingsTest, AreDrawnAndGo) {
  bool is_drawn = false;
  const ros::Subscriber subscriber = node.subscribe<visualization_msgs::MarkerArray>(
      "/proximity/markers", 1000, [&](const visualization_msgs::MarkerArray::ConstPtr& message) {
        for (const visualization_msgs::Marker& marker : message->markers) {
          if (marker.ns == "crossings") {
            is_drawn = marker.action == visualization_msgs::Marker::ADD;
            EXPECT_EQ(marker.points.size(), is_drawn ? 6U : 0U);
          }
        }
      });
  const ros::Publisher publisher = advertise<fiber_proximity::FiberArray>("fibers");
  connect(publisher, cross(), [&] { return is_drawn; });
  const auto becomes = [&](const fiber_proximity::FiberArray& message, bool drawn) {
    fiber_proximity::FiberArray stamped = message;
    stamped.header.stamp = new_stamp();
    publisher.publish(stamped);
    return node_test::wait_for([&] { return is_drawn == drawn; });
  };
  EXPECT_TRUE(becomes(
      test_messages::fiber_array(test_messages::header("world"), {{0, 0, 0}, {1, 0, 0}}), false));
  EXPECT_TRUE(becomes(cross(), true));
}

// From below, once tf knows where the camera is.
TEST_F(CrossingsCameraTest, AreSeenFromTheCamera) {
  const ros::Publisher publisher = advertise<fiber_proximity::FiberArray>("fibers");
  connect(publisher, cross(), [&] { return !logs_of("no crossings: ").empty(); });
  ASSERT_FALSE(logs_of("no crossings: ").empty());
  EXPECT_NE(logs_of("no crossings: ")[0].find("'camera'"), std::string::npos);
  EXPECT_TRUE(crossings.messages.empty());
  tf2_ros::StaticTransformBroadcaster broadcaster;
  broadcaster.sendTransform(test_messages::transform("camera", {0.5, 0.0, -2.0}));
  ASSERT_TRUE(node_test::wait_for([&] {
    fiber_proximity::FiberArray message = cross();
    message.header.stamp = new_stamp();
    publisher.publish(message);
    return !crossings.messages.empty();
  }));
  const CrossingArray& answer = *crossings.messages.back();
  EXPECT_TRUE(answer.is_perspective);
  EXPECT_EQ(to_vector(answer.direction), Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(to_vector(answer.eye), Eigen::Vector3d(0.5, 0, -2));
  expect_cross(answer, true);
}

// The node ends with an error that names the parameter.
TEST_F(CrossingsCameraTest, BadParametersAreRefused) {
  const auto output_with = [](const std::string& yaml) {
    ros::NodeHandle("/refused").deleteParam("crossings");
    const std::string command = "rosparam set /refused/crossings '" + yaml + "'";
    EXPECT_EQ(std::system(command.c_str()), 0);  // NOLINT(bugprone-command-processor)
    std::string output;
    const char* const program = PROXIMITY_NODE " __name:=refused 2>&1";
    FILE* const pipe = popen(program, "r");  // NOLINT(bugprone-command-processor)
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
      output.push_back(static_cast<char>(c));
    }
    EXPECT_EQ(WEXITSTATUS(pclose(pipe)), 2) << yaml;
    return output;
  };
  for (const std::string yaml : {"{direction: [0, 0, 0]}", "{direction: [1, 2]}", "{direction: up}",
                                 "{direction: [.nan, 0, 1]}"}) {
    EXPECT_NE(output_with(yaml).find("parameter /refused/crossings/direction is "),
              std::string::npos)
        << yaml;
  }
  EXPECT_NE(output_with("{camera_frame: 3}").find("/refused/crossings/camera_frame is 3"),
            std::string::npos);
  EXPECT_NE(output_with("{camera_frame: a, direction: [1, 0, 0]}").find(", not both"),
            std::string::npos);
  EXPECT_NE(output_with("above").find("/refused/crossings is above"), std::string::npos);
}

}  // namespace
