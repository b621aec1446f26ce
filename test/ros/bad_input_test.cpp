// What the running node does with messages nobody should send: one clear error, nothing else.
#include <tf2_msgs/TFMessage.h>

#include "test/ros/bad_input_fixture.hpp"
#include "test/support/not_finite.hpp"

namespace {

using fiber_proximity::FiberArray;
using node_test::BadInputTest;
using test_messages::header;
using test_messages::Points;
using visualization_msgs::Marker;

using fiber::test::infinity;
using fiber::test::nan;

TEST_F(BadInputTest, MalformedFiberArraysAreRefused) {
  FiberArray message = array();
  message.points[2].y = nan;
  expect_refused("nan_point", message, "fibre 0, point 2: y is nan");

  message = array();
  message.points[3].z = -infinity;
  expect_refused("infinite_point", message, "fibre 0, point 3: z is -inf");

  message = array();
  message.radii = {-0.5};
  expect_refused("negative_radius", message, "the radius is -0.5");

  message = array();
  message.offsets = {0, 2, 4};
  message.radii = {0.5, nan};
  expect_refused("nan_radius", message, "fibre 1: the radius is nan");

  message = array();
  message.radii = {0.5, 0.5};
  expect_refused("radius_count", message, "2 radii for 1 fibre(s) of 4 points");

  message = array();
  message.offsets = {0, 3, 2, 4};
  expect_refused("decreasing_offsets", message, "fibre 1: offsets decrease from 3 to 2");

  message = array();
  message.offsets = {0, 2, 7};
  expect_refused("overrunning_offsets", message, "fibre 1: offset 7 lies beyond the 4 points");

  message = array();
  message.offsets = {0, 2};
  expect_refused("points_left_over", message, "the last offset is 2, but there are 4 points");

  message = array();
  message.offsets.clear();
  expect_refused("no_offsets", message, "offsets must start with 0, but are empty");

  message = array();
  message.offsets = {0, 3, 4};
  expect_refused("one_point", message, "fibre 1: has 1 point(s), a fibre needs at least 2");

  message = array();
  message.offsets = {0, 4, 4};
  expect_refused("empty_fiber", message, "fibre 1: has 0 point(s), a fibre needs at least 2");

  message = array();
  message.names = {"one", "too many"};
  expect_refused("names", message, "2 names for 1 fibre(s)");
}

TEST_F(BadInputTest, MessagesWithoutATransformAreRefused) {
  expect_refused("no_frame", array(""), "header.frame_id is empty");
  expect_refused("unknown_frame", array("nowhere"),
                 "no transform from frame 'nowhere' to 'world' at time ");
  EXPECT_FALSE(logs_of("unknown frame: ").empty());
  expect_refused("island", array("crater"), "no transform from frame 'crater' to 'world' at time ");
  EXPECT_FALSE(logs_of("frames not connected: ").empty());

  // Known now, but not at the time of the message.
  tf2_msgs::TFMessage transforms;
  transforms.transforms.resize(1);
  geometry_msgs::TransformStamped& transform = transforms.transforms.front();
  transform.header = header("world", ros::Time::now() - ros::Duration(100.0));
  transform.child_frame_id = "moving";
  transform.transform.rotation.w = 1.0;
  const ros::Publisher tf = advertise<tf2_msgs::TFMessage>("/tf");
  tf.publish(transforms);
  fiber_proximity::QueryProximity query;
  query.request.shapes.resize(1);
  query.request.shapes[0].header.frame_id = "moving";
  query.request.shapes[0].points.resize(1);
  ASSERT_TRUE(node_test::wait_for([&] {
    return node_test::call_service("/proximity/query", query) && query.response.success;
  })) << query.response.message;
  FiberArray message = array("moving");
  message.header.stamp = transform.header.stamp + ros::Duration(100.0);
  expect_refused("future", message, "no transform from frame 'moving' to 'world' at time ");
  EXPECT_FALSE(logs_of("not known at that time: ").empty());
}

TEST_F(BadInputTest, MalformedCloudsAreRefused) {
  sensor_msgs::PointCloud2 message = cloud();
  message.fields[0].name = "u";
  expect_refused("cloud_without_x", message, "the cloud has no field 'x', it needs x, y and z");

  message = cloud();
  message.fields[2].datatype = sensor_msgs::PointField::INT32;
  expect_refused("cloud_of_integers", message, "field 'z' has datatype 5");

  message = cloud();
  message.point_step += 4;
  expect_refused("cloud_with_wrong_step", message, "row_step is ");

  message = cloud();
  message.is_bigendian = 1;
  expect_refused("big_endian_cloud", message, "the cloud is big-endian");

  Points points = chain();
  points[1].x() = nan;
  expect_refused("nan_cloud", cloud(points), "fibre 0, point 1: x is nan");
  expect_refused("empty_cloud", cloud({}), "fibre 0: has 0 point(s), a fibre needs at least 2");
}

TEST_F(BadInputTest, MalformedPosesAndMarkersAreRefused) {
  const std_msgs::Header world = header("world", new_stamp());
  expect_refused("one_pose", test_messages::pose_array(world, {{0, 0, 0}}),
                 "fibre 0: has 1 point(s), a fibre needs at least 2");

  nav_msgs::Path path = test_messages::path(world, chain());
  path.poses[3].header.frame_id = "gripper";
  expect_refused("path_frames", path, "pose 3 is in frame 'gripper', the path in 'world'");

  expect_refused("odd_line_list",
                 test_messages::marker(world, Marker::LINE_LIST, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}),
                 "marker cable/0: a LINE_LIST of 3 points");

  visualization_msgs::MarkerArray markers;
  markers.markers.push_back(test_messages::marker(world, Marker::TEXT_VIEW_FACING, {}));
  expect_refused("text_marker", markers, "marker cable/0 has type 9; fibres are read from ");
}

TEST_F(BadInputTest, AFloodOfBadMessagesIsLoggedAtALowRate) {
  const ros::Publisher publisher = advertise<FiberArray>("bad/flood");
  FiberArray message = array();
  const ros::SteadyTime begin = ros::SteadyTime::now();
  const fiber_proximity::InputStatistics* input = nullptr;
  ASSERT_TRUE(node_test::wait_for([&] {
    for (int i = 0; i < 5; ++i) {
      message.points[static_cast<std::size_t>(i % 4)].x = nan;  // another text each time
      publisher.publish(message);
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.001));
    }
    good_.publish(good_message());
    input = input_of(*statistics.messages.back(), "bad/flood");
    return input != nullptr && input->refused > 100;
  }));
  const double seconds = (ros::SteadyTime::now() - begin).toSec();
  EXPECT_GE(logs_of("bad/flood").size(), 1U);
  EXPECT_LE(static_cast<double>(logs_of("bad/flood").size()), 2.0 + seconds);
}

/// The number in "(and N more refused since)", 0 without.
std::uint64_t more_in(const std::string& log) {
  const std::string before = "(and ";
  const std::size_t found = log.find(before);
  return found == std::string::npos ? 0 : std::stoul(log.substr(found + before.size()));
}

TEST_F(BadInputTest, OneReasonDoesNotHideAnother) {
  const ros::Publisher publisher = advertise<FiberArray>("bad/reasons");
  FiberArray frequent = array();
  frequent.points[2].y = nan;
  FiberArray rare = array();
  rare.names = {"one", "too many"};
  // Both reasons; the frequent one again and again, until it is logged another time.
  publisher.publish(frequent);
  ASSERT_TRUE(node_test::wait_for([this] { return !logs_of("point 2: y is nan").empty(); }));
  publisher.publish(rare);
  ASSERT_TRUE(node_test::wait_for([this] { return !logs_of("2 names for 1 fibre(s)").empty(); }))
      << "hidden by the other reason";
  std::uint64_t sent = 1;
  ASSERT_TRUE(node_test::wait_for([&] {
    publisher.publish(frequent);
    ++sent;
    return logs_of("point 2: y is nan").size() > 1;
  }));
  // All that were refused are told of, each once.
  const std::vector<std::string> told = logs_of("point 2: y is nan");
  EXPECT_GT(more_in(told[1]), 0U);
  EXPECT_LE(more_in(told[1]) + 2, sent);
}

}  // namespace
