// Point clouds as obstacles, through the real graph.
#include <sensor_msgs/PointCloud2.h>

#include "fiber_proximity/environment/occupancy_octree.hpp"
#include "test/ros/environment_fixture.hpp"
#include "test/support/not_finite.hpp"

namespace environment_test {
namespace {

using fiber::test::nan;
using sensor_msgs::PointCloud2;
using test_messages::Points;

class CloudTest : public EnvironmentFixture {
 protected:
  void start_with_topic() {
    start();
    publisher_ = advertise<PointCloud2>("cloud");
  }

  void publish(const Points& points, const std::string& from = "world",
               const ros::Time& stamp = ros::Time()) {
    publisher_.publish(test_messages::point_cloud2(test_messages::header(from, stamp), points));
  }

  /// Centres of the cells there are.
  Points cells() const {
    for (const fiber::EnvironmentObject& object : inputs->environment()->objects()) {
      if (object.name == "cloud") {
        using Octree = std::shared_ptr<const fiber::OccupancyOctree>;
        EXPECT_EQ(object.shapes.size(), 1U);
        return std::get<Octree>(object.shapes[0].shape)->centres();
      }
    }
    return {};
  }

  ros::Publisher publisher_;
};

TEST_F(CloudTest, TheNewestCloudIsThere) {
  own.setParam("cloud/resolution", 1.0);
  own.setParam("cloud/box/max", std::vector<double>{100.0, 100.0, 20.0});
  static_transforms.sendTransform(transform("camera", 10.0));
  start_with_topic();
  EXPECT_TRUE(inputs->is_used());
  EXPECT_TRUE(cells().empty());
  publish({{0.25, 0, 0}, {0.75, 0, 0}, {nan, nan, nan}, {0, 0, 30}}, "camera");
  ASSERT_TRUE(wait_for([&] { return !cells().empty(); }));
  EXPECT_EQ(cells(), (Points{{10.5, 0.5, 0.5}}));
  EXPECT_EQ(statistics_of("cloud").points_received, 4U);
  EXPECT_EQ(statistics_of("cloud").points_not_finite, 1U);
  EXPECT_EQ(statistics_of("cloud").points_outside_box, 1U);
  publish({{5.25, 0, 0}});
  ASSERT_TRUE(wait_for([&] { return cells() == Points{{5.5, 0.5, 0.5}}; }));
  publish({});
  ASSERT_TRUE(wait_for([&] { return cells().empty(); }));
  EXPECT_EQ(statistics_of("cloud").received, 3U);
  EXPECT_EQ(statistics_of("cloud").refused, 0U);
}

TEST_F(CloudTest, AllCellsGoWhenNoCloudComesForAsLongAsTheDecay) {
  own.setParam("cloud/resolution", 1.0);
  own.setParam("cloud/decay", 0.2);
  start_with_topic();
  publish({{0.5, 0.5, 0.5}});
  ASSERT_TRUE(wait_for([&] { return statistics_of("cloud").points_received == 1; }));
  ASSERT_TRUE(wait_for([&] { return cells().empty(); }));
}

TEST_F(CloudTest, WhereAllCellsHaveDecayedIsUnknown) {
  own.setParam("cloud/resolution", 1.0);
  own.setParam("cloud/decay", 0.2);
  own.setParam("cloud/timeout", 100.0);
  start_with_topic();
  publish({{0.5, 0.5, 0.5}});
  ASSERT_TRUE(wait_for([&] { return !cells().empty(); }));
  EXPECT_EQ(unknown(), std::vector<std::string>{});
  ASSERT_TRUE(wait_for([&] { return cells().empty(); }));
  EXPECT_EQ(unknown(), (std::vector<std::string>{
                           "cloud: all cells have decayed: no new cloud for 0.2 s (cloud/decay)"}));
  publish({{0.5, 0.5, 0.5}});
  ASSERT_TRUE(wait_for([&] { return unknown().empty(); }));
}

/// The same stamp again and again is of a camera that has frozen.
TEST_F(CloudTest, ACloudThatRepeatsItselfIsNoNewOne) {
  own.setParam("cloud/timeout", 0.3);
  start_with_topic();
  const ros::Time stamp = ros::Time::now();
  publish({{0.5, 0.5, 0.5}}, "world", stamp);
  ASSERT_TRUE(wait_for([&] { return unknown().empty(); }));
  ASSERT_TRUE(wait_for([&] {
    publish({{0.5, 0.5, 0.5}}, "world", stamp);
    return !unknown().empty();
  }));
  EXPECT_EQ(unknown().front(), "cloud: no new cloud for 0.3 s (cloud/timeout)");
  EXPECT_FALSE(cells().empty()) << "what was seen last is there still";
  publish({{0.5, 0.5, 0.5}}, "world", stamp + ros::Duration(0.1));
  EXPECT_TRUE(wait_for([&] { return unknown().empty(); }));
}

TEST_F(CloudTest, IsForgottenWhenTimeGoesBack) {
  own.setParam("cloud/timeout", 100.0);
  start_with_topic();
  const ros::Time begin = ros::Time::now();
  ros::Time::setNow(begin);
  publish({{0.5, 0.5, 0.5}});
  ASSERT_TRUE(wait_for([&] { return !cells().empty(); }));
  ros::Time::setNow(begin - ros::Duration(1000.0));
  EXPECT_TRUE(inputs->update(ros::Time::now()));
  EXPECT_TRUE(cells().empty());
  EXPECT_EQ(unknown(), (std::vector<std::string>{"cloud: no cloud yet"}));
  publish({{1.5, 0.5, 0.5}});
  EXPECT_TRUE(wait_for([&] { return !cells().empty(); }));
  EXPECT_EQ(unknown(), std::vector<std::string>{});
  ros::Time::init();  // the clock of the machine again
}

TEST_F(CloudTest, OneThatCannotBeUsedDoesNotChooseTheFixedFrame) {
  fiber_proximity_ros::FixedFrame any("", node);
  own.setParam("cloud", true);
  inputs = std::make_unique<EnvironmentInputs>(node, own, options(), any, [] {});
  publisher_ = advertise<PointCloud2>("cloud");
  PointCloud2 bad = test_messages::point_cloud2(test_messages::header("wrold"), {{1, 1, 1}});
  bad.fields[0].name = "u";
  publisher_.publish(bad);
  ASSERT_TRUE(wait_for([&] { return statistics_of("cloud").refused == 1; }));
  Obstacle box = ball("ball", 0.0, "wrold");
  box.primitives[0].dimensions[0] = -1.0;
  EXPECT_NE(apply({box}), "");
  EXPECT_EQ(any.name(), "");
  publish({{0.5, 0.5, 0.5}});
  EXPECT_TRUE(wait_for([&] { return !cells().empty(); }));
  EXPECT_EQ(any.name(), "world");
  inputs.reset();  // before its frame
}

TEST_F(CloudTest, ABadCloudChangesNothing) {
  own.setParam("cloud", true);
  start_with_topic();
  publish({{0.5, 0.5, 0.5}});
  ASSERT_TRUE(wait_for([&] { return !cells().empty(); }));
  const Points before = cells();
  std::uint64_t refused = 0;
  const auto expect_refusal = [&](const PointCloud2& cloud, const std::string& reason) {
    publisher_.publish(cloud);
    ++refused;
    ASSERT_TRUE(wait_for([&] { return statistics_of("cloud").refused == refused; }));
    EXPECT_NE(statistics_of("cloud").last_error.find(reason), std::string::npos)
        << statistics_of("cloud").last_error;
    EXPECT_EQ(cells(), before);
  };
  const PointCloud2 good = test_messages::point_cloud2(test_messages::header("world"), {{1, 1, 1}});
  PointCloud2 bad = good;
  bad.fields[0].name = "u";
  expect_refusal(bad, "no field 'x'");
  bad = good;
  bad.data.pop_back();
  expect_refusal(bad, "bytes");
  bad = good;
  bad.header.frame_id = "";
  expect_refusal(bad, "frame_id is empty");
  bad = good;
  bad.header.frame_id = "moon";
  expect_refusal(bad, "'moon'");
  bad = good;
  bad.header.stamp = ros::Time::now() + ros::Duration(3600.0);
  expect_refusal(bad, "it may be 1 s ahead (max_stamp_ahead)");
}

TEST_F(CloudTest, WhatBecomesOfThePointsIsTold) {
  own.setParam("cloud/resolution", 0.02);
  own.setParam("cloud/box/max", std::vector<double>{1e40, 1e40, 2.0});
  start_with_topic();
  const node_test::Recorder<rosgraph_msgs::Log> logs(node, "/rosout");
  ASSERT_TRUE(node_test::wait_for([&] {
    ROS_INFO("is the log heard?");
    return !logs.messages.empty();
  }));
  std::uint64_t received = 0;
  const auto send = [&](const Points& points) {
    publish(points);
    ++received;
    EXPECT_TRUE(wait_for(
        [&] { return statistics_of("cloud").received == received && !inputs->is_waiting(); }));
    return statistics_of("cloud");
  };
  fiber_proximity::InputStatistics told =
      send({{0, 0, 1}, {0, 0, 1}, {nan, 0, 1}, {0, 0, 3}, {0, 1e30, 1}, {700, 0, 1}});
  EXPECT_EQ(told.points_received, 6U);
  EXPECT_EQ(told.points_used, 2U);
  EXPECT_EQ(told.points_not_finite, 1U);
  EXPECT_EQ(told.points_outside_box, 1U);
  EXPECT_EQ(told.points_too_far, 2U);
  EXPECT_EQ(cells().size(), 1U);
  // Millimetres, in front of the box's end.
  told = send({{0, 900, 1}, {700, 0, 1}, {nan, nan, nan}});
  EXPECT_EQ(told.points_used, 0U);
  EXPECT_TRUE(cells().empty());
  const auto* log = logs.wait_for([](const rosgraph_msgs::Log& message) {
    return message.msg.find("(sensor_msgs/PointCloud2): none of its 3 point(s) is used") !=
           std::string::npos;
  });
  ASSERT_NE(log, nullptr);
  EXPECT_EQ(log->level, rosgraph_msgs::Log::WARN);
  EXPECT_NE(log->msg.find("1 is not finite, 2 are further than 655.36 m"), std::string::npos)
      << log->msg;
  EXPECT_EQ(send({}).points_received, 0U);
}

TEST_F(CloudTest, ACloudKeepsItsTurnUntilItsTransformComes) {
  own.setParam("cloud/resolution", 1.0);
  start_with_topic();
  publish({{0.5, 0.5, 0.5}}, "slow");
  ASSERT_TRUE(wait_for([&] { return statistics_of("cloud").received == 1; }));
  EXPECT_TRUE(inputs->is_waiting());
  static_transforms.sendTransform(transform("slow", 3.0));
  wait_for([&] { return !inputs->is_waiting(); });
  // It may have waited for too long on a busy machine: then the next one is in time.
  if (statistics_of("cloud").refused > 0) {
    publish({{0.5, 0.5, 0.5}}, "slow");
  }
  ASSERT_TRUE(wait_for([&] { return !cells().empty(); }));
  EXPECT_EQ(cells(), (Points{{3.5, 0.5, 0.5}}));
}

}  // namespace
}  // namespace environment_test
