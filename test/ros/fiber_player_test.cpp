#include "src/ros/player/fiber_player.hpp"

#include <geometry_msgs/PoseArray.h>
#include <gtest/gtest.h>
#include <nav_msgs/Path.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <sys/wait.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <functional>
#include <vector>

#include "fiber_proximity/FiberArray.h"
#include "fiber_proximity/io/fiber_file.hpp"
#include "src/scenes/scenes.hpp"

namespace fiber_proximity_ros {
namespace {

constexpr std::size_t frame_count = 3;

/// Two fibres, of 2 and 3 points; frame f is moved by f along x.
fiber::FiberAssembly fibers_at(std::size_t frame) {
  const auto x = static_cast<double>(frame);
  return {{{x, 0, 0.5}, {x + 1, 0, 0.5}, {x, 2, 0.25}, {x + 1, 2, 0.25}, {x + 1, 3, 0.25}},
          {0, 2, 5},
          {0.125, 0.125, 0.25, 0.25, 0.25}};
}

std::string recording() {
  fiber::FiberFile file;
  file.has_frames = true;
  for (std::size_t frame = 0; frame < frame_count; ++frame) {
    file.frames.push_back({static_cast<std::int64_t>(frame), fibers_at(frame)});
  }
  std::string path = testing::TempDir() + "fiber_player_test.csv";
  fiber::write_csv(path, file);
  return path;
}

bool spin_until(const std::function<bool()>& condition, double seconds = 120.0) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
  while (!condition() && ros::WallTime::now() < end) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.02));
  }
  return condition();
}

/// A subscriber that was there before the player.
template <class Message>
class Heard {
 public:
  explicit Heard(const std::string& topic)
      : subscriber_(node_.subscribe<Message>(
            topic, 1000, [this](const boost::shared_ptr<const Message>& message) {
              messages_.push_back(message);
            })) {}

  /// Waits, without letting the player play, until it is heard.
  bool is_connected() const {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(120.0);
    while (subscriber_.getNumPublishers() == 0 && ros::WallTime::now() < end) {
      ros::WallDuration(0.01).sleep();
    }
    return subscriber_.getNumPublishers() > 0;
  }

  std::size_t count() const { return messages_.size(); }
  const Message& operator[](std::size_t i) const { return *messages_.at(i); }

 private:
  ros::NodeHandle node_;
  std::vector<boost::shared_ptr<const Message>> messages_;
  ros::Subscriber subscriber_;
};

PlayerOptions fast(const std::string& format) {
  PlayerOptions options = read_player_options(ros::NodeHandle("~"));
  options.file = recording();
  options.rate = 100.0;
  options.format = format;
  options.topic = "played/" + format;
  return options;
}

void expect_header(const std_msgs::Header& header) {
  EXPECT_EQ(header.frame_id, "world");
  EXPECT_LT(std::abs((ros::Time::now() - header.stamp).toSec()), 60.0);
}

template <class Point>
void expect_point(const Point& point, const Eigen::Vector3d& expected) {
  EXPECT_EQ(point.x, expected.x());
  EXPECT_EQ(point.y, expected.y());
  EXPECT_EQ(point.z, expected.z());
}

TEST(FiberPlayer, PlaysEveryFrameInOrderAndBeginsAgain) {
  const Heard<fiber_proximity::FiberArray> heard("played/fiber_array");
  const FiberPlayer player(ros::NodeHandle(), fast("fiber_array"));
  ASSERT_TRUE(spin_until([&] { return heard.count() > 2 * frame_count; }));
  // The subscriber may have been connected a few frames late.
  const auto first = static_cast<std::size_t>(heard[0].points.at(0).x);
  for (std::size_t i = 0; i <= 2 * frame_count; ++i) {
    const fiber::FiberAssembly expected = fibers_at((first + i) % frame_count);
    const fiber_proximity::FiberArray& message = heard[i];
    expect_header(message.header);
    EXPECT_EQ(message.offsets, expected.offsets());
    EXPECT_EQ(message.radii, expected.radii());
    ASSERT_EQ(message.points.size(), expected.point_count());
    for (std::size_t p = 0; p < expected.point_count(); ++p) {
      expect_point(message.points[p], expected.points()[p]);
    }
  }
}

TEST(FiberPlayer, StopsAfterTheLastFrameWithoutLoop) {
  const Heard<fiber_proximity::FiberArray> heard("played/once");
  PlayerOptions options = fast("fiber_array");
  options.topic = "played/once";
  options.loop = false;
  const FiberPlayer player(ros::NodeHandle(), options);
  ASSERT_TRUE(heard.is_connected());
  const auto last_is_heard = [&] {
    return heard.count() > 0 && heard[heard.count() - 1].points.at(0).x == frame_count - 1;
  };
  ASSERT_TRUE(spin_until(last_is_heard));
  const std::size_t count = heard.count();
  EXPECT_LE(count, frame_count);
  EXPECT_FALSE(spin_until([&] { return heard.count() > count; }, 0.5));
}

TEST(FiberPlayer, PlaysASceneWithoutEnd) {
  const Heard<fiber_proximity::FiberArray> heard("fibers");
  const FiberPlayer player(ros::NodeHandle(), read_player_options(ros::NodeHandle("~")));
  ASSERT_TRUE(spin_until([&] { return heard.count() >= 5; }));
  EXPECT_EQ(heard[0].offsets, fiber::cables(0.0).offsets());
  EXPECT_NE(heard[0].points[20].y, heard[4].points[20].y);
}

/// One fibre in a tracker's message: the points of the second fibre.
template <class Message>
void expect_second_fiber(const std::string& format,
                         const std::function<std::vector<Eigen::Vector3d>(const Message&)>& read) {
  const Heard<Message> heard("played/" + format);
  PlayerOptions options = fast(format);
  options.fiber = 1;
  const FiberPlayer player(ros::NodeHandle(), options);
  ASSERT_TRUE(spin_until([&] { return heard.count() > frame_count; }));
  for (std::size_t i = 0; i <= frame_count; ++i) {
    expect_header(heard[i].header);
    const std::vector<Eigen::Vector3d> points = read(heard[i]);
    ASSERT_EQ(points.size(), 3U);
    const fiber::FiberAssembly expected = fibers_at(static_cast<std::size_t>(points[0].x()));
    for (std::size_t p = 0; p < 3; ++p) {
      EXPECT_EQ(points[p], expected.points()[2 + p]);
    }
  }
}

template <class Points>
std::vector<Eigen::Vector3d> to_points(const Points& points) {
  std::vector<Eigen::Vector3d> result;
  for (const auto& point : points) {
    result.emplace_back(point.x, point.y, point.z);
  }
  return result;
}

TEST(FiberPlayer, PlaysOneFiberAsPointCloud2) {
  expect_second_fiber<sensor_msgs::PointCloud2>(
      "point_cloud2", [](const sensor_msgs::PointCloud2& message) {
        std::vector<Eigen::Vector3d> points;
        for (sensor_msgs::PointCloud2ConstIterator<float> xyz(message, "x"); xyz != xyz.end();
             ++xyz) {
          points.emplace_back(xyz[0], xyz[1], xyz[2]);
        }
        return points;
      });
}

TEST(FiberPlayer, PlaysOneFiberAsPointCloud) {
  expect_second_fiber<sensor_msgs::PointCloud>(
      "point_cloud",
      [](const sensor_msgs::PointCloud& message) { return to_points(message.points); });
}

TEST(FiberPlayer, PlaysOneFiberAsPoseArray) {
  expect_second_fiber<geometry_msgs::PoseArray>(
      "pose_array", [](const geometry_msgs::PoseArray& message) {
        std::vector<geometry_msgs::Point> points;
        for (const geometry_msgs::Pose& pose : message.poses) {
          points.push_back(pose.position);
        }
        return to_points(points);
      });
}

TEST(FiberPlayer, PlaysOneFiberAsPath) {
  expect_second_fiber<nav_msgs::Path>("path", [](const nav_msgs::Path& message) {
    std::vector<geometry_msgs::Point> points;
    for (const geometry_msgs::PoseStamped& pose : message.poses) {
      EXPECT_EQ(pose.header.frame_id, message.header.frame_id);
      points.push_back(pose.pose.position);
    }
    return to_points(points);
  });
}

TEST(FiberPlayer, PlaysOneFiberAsMarker) {
  expect_second_fiber<visualization_msgs::Marker>(
      "marker", [](const visualization_msgs::Marker& message) {
        EXPECT_EQ(message.type, visualization_msgs::Marker::LINE_STRIP);
        EXPECT_EQ(message.scale.x, 0.5);
        return to_points(message.points);
      });
}

TEST(FiberPlayer, PlaysAllFibersAsMarkerArray) {
  const Heard<visualization_msgs::MarkerArray> heard("played/marker_array");
  const FiberPlayer player(ros::NodeHandle(), fast("marker_array"));
  ASSERT_TRUE(spin_until([&] { return heard.count() > 0; }));
  ASSERT_EQ(heard[0].markers.size(), 2U);
  EXPECT_EQ(heard[0].markers[0].points.size(), 2U);
  EXPECT_EQ(heard[0].markers[1].points.size(), 3U);
  EXPECT_EQ(heard[0].markers[1].id, 1);
  EXPECT_EQ(heard[0].markers[1].scale.x, 0.5);
}

struct Outcome {
  int exit_code = -1;
  std::string errors;
};

/// Runs the real node with these arguments until it ends.
Outcome run_player(const std::string& arguments) {
  ros::param::del("/bad_player");  // parameters of an earlier run
  const std::string command =
      std::string(FIBER_PLAYER) + " __name:=bad_player " + arguments + " 2>&1 >/dev/null";
  Outcome outcome;
  std::FILE* const pipe = popen(command.c_str(), "r");
  std::array<char, 256> buffer{};
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) {
    outcome.errors += buffer.data();
  }
  const int status = pclose(pipe);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

void expect_refusal(const std::string& arguments, const std::vector<std::string>& mentions) {
  SCOPED_TRACE(arguments);
  const Outcome outcome = run_player(arguments);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
  for (const std::string& mention : mentions) {
    EXPECT_NE(outcome.errors.find(mention), std::string::npos) << outcome.errors;
  }
}

TEST(FiberPlayer, BadParametersEndTheNodeWithOneLine) {
  const std::string bad = testing::TempDir() + "fiber_player_test_bad.csv";
  std::ofstream(bad) << "fiber,x,y,z\n0,0,0,0\n0,one,0,0\n";
  const std::string good = recording();
  expect_refusal("_file:=/no/such/file.csv", {"/no/such/file.csv"});
  expect_refusal("_file:=" + bad, {bad, "3"});
  expect_refusal("_format:=telegram", {"telegram", "point_cloud2"});
  expect_refusal("_scene:=opera", {"opera", "cables"});
  expect_refusal("_file:=" + good + " _scene:=cables", {good, "cables"});
  expect_refusal("_file:=" + good + " _format:=point_cloud2",
                 {"2 fibres", "point_cloud2", "fiber"});
  expect_refusal("_file:=" + good + " _fiber:=2", {"fiber is 2", "2 fibre(s)"});
  expect_refusal("_rate:=0", {"/bad_player/rate", "0"});
  expect_refusal("_rate:=quick", {"/bad_player/rate", "quick"});
  expect_refusal("_rate:=1e6", {"/bad_player/rate", "a number from 0.001 to 1000"});
  expect_refusal("_topic:=a-b", {"/bad_player/topic is a-b", "a ROS name"});
  expect_refusal("_frame_id:=", {"/bad_player/frame_id", "the name of a frame"});
  expect_refusal("_radius:=-1", {"/bad_player/radius", "-1"});
  expect_refusal("_loop:=maybe", {"/bad_player/loop", "maybe"});
  expect_refusal("_fiber:=-2", {"FATAL", "/bad_player/fiber is -2", "at least -1"});
  expect_refusal("_fiber:=0.5", {"/bad_player/fiber is 0.5", "a whole number"});
  expect_refusal("_start_delay:=1e12", {"/bad_player/start_delay", "from 0 to 1e+09"});
}

}  // namespace
}  // namespace fiber_proximity_ros

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "fiber_player_test");
  const ros::NodeHandle node;
  return RUN_ALL_TESTS();
}
