// Obstacles of the simulation that frames of tf move, links of robots among them, through the real
// graph.
#include <geometry_msgs/WrenchStamped.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "fiber_proximity/ObstacleArray.h"
#include "fiber_proximity/Predict.h"
#include "fiber_proximity/ros/conversions.hpp"
#include "test/ros/cable_sim_fixture.hpp"
#include "test/ros/messages.hpp"
#include "test/ros/own_scene_fixture.hpp"

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using fiber_proximity_ros::to_vector;

/// Of sim_obstacles.yaml: each cable has a post, whose axis goes through its frame's (0, -0.1, 0).
constexpr std::size_t cables = 2;
constexpr std::size_t nodes = 21;
constexpr double cable_radius = 0.005;
constexpr double post_radius = 0.02;
constexpr double time_step = 0.01;
const std::array<std::string, cables> posts{"finger", "post"};

geometry_msgs::TransformStamped transform_to(const std::string& frame, const Vector3d& position,
                                             double angle) {
  return test_messages::transform(
      test_messages::header("world", ros::Time::now()), frame,
      Eigen::Translation3d(position) * Eigen::AngleAxisd(angle, Vector3d::UnitZ()));
}

/// What is true of one cable and its post after a frame.
struct Pushed {
  std::vector<Vector3d> points;
  Vector3d post;  // the middle of its axis
  Vector3d wrench;

  /// By the densities of a silicone tube; nodes at the ends have half an edge each [kg m].
  Vector3d moment_of_mass() const {
    const double edge = 1150.0 * M_PI * cable_radius * cable_radius * 0.02;
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      sum += (i == 0 || i + 1 == points.size() ? 0.5 : 1.0) * edge * points[i];
    }
    return sum;
  }

  /// Of the axes: all of it is across the post [m].
  double distance() const {
    double least = 1e9;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const Vector2d a = (points[i] - post).head<2>();
      const Vector2d way = (points[i + 1] - points[i]).head<2>();
      const double share = std::clamp(-a.dot(way) / way.squaredNorm(), 0.0, 1.0);
      least = std::min(least, (a + share * way).norm());
    }
    return least;
  }
};

class SimObstaclesTest : public CableSimTest {
 protected:
  /// Begins again with both posts 10 cm beside their cables.
  void SetUp() override {
    ASSERT_TRUE(node_test::wait_for([this] {
      send(0.0, 0.0);
      return !fibers.messages.empty() && !obstacles.messages.empty();
    }));
    ASSERT_TRUE(go(0.0, 0.0));
    reset();
    const ros::Time begin = ros::Time::now();  // the topics of wrenches are others now
    ASSERT_TRUE(node_test::wait_for([&] {
      step(1);
      return std::all_of(wrenches.begin(), wrenches.end(), [&begin](const auto& each) {
        return !each.messages.empty() && each.messages.back()->header.stamp > begin;
      });
    }));
    hears_wrenches_ = true;
    advance();
    seen.clear();
  }

  void send(double y, double angle) {
    broadcaster_.sendTransform(
        {transform_to("finger", {0.0, y, 0.0}, angle), transform_to("tool", {0.0, y, 1.0}, angle)});
  }

  /// One frame, of which all is heard.
  void advance() {
    const auto count = [this] {
      return std::array{fibers.messages.size(), obstacles.messages.size(),
                        wrenches[0].messages.size(), wrenches[1].messages.size()};
    };
    const auto before = count();
    const std::ptrdiff_t heard = hears_wrenches_ ? 4 : 2;
    step(1);
    ASSERT_TRUE(node_test::wait_for([&] {
      const auto now = count();
      return std::equal(now.begin(), now.begin() + heard, before.begin(), std::greater<>());
    }));
    if (!hears_wrenches_) {
      return;
    }
    std::array<Pushed, cables> both;
    const std::vector<Vector3d> points = node_test::to_assembly(*fibers.messages.back()).points();
    for (std::size_t i = 0; i < cables; ++i) {
      const auto first = points.begin() + static_cast<std::ptrdiff_t>(nodes * i);
      both[i] = {
          {first, first + nodes}, post(i), to_vector(wrenches[i].messages.back()->wrench.force)};
    }
    seen.push_back(both);
  }

  /// Where the axis of a post is.
  Vector3d post(std::size_t index) const {
    for (const fiber_proximity::Obstacle& obstacle : obstacles.messages.back()->obstacles) {
      if (obstacle.id == posts[index]) {
        const Vector3d in_object = obstacle.primitive_poses.empty()
                                       ? Vector3d(Vector3d::Zero())
                                       : to_vector(obstacle.primitive_poses[0].position);
        const geometry_msgs::Quaternion& turn = obstacle.pose.orientation;
        return to_vector(obstacle.pose.position) +
               Eigen::Quaterniond(turn.w, turn.x, turn.y, turn.z) * in_object;
      }
    }
    ADD_FAILURE() << "no obstacle " << posts[index];
    return Vector3d::Zero();
  }

  /// Frame by frame until both posts are where their frames are sent.
  bool go(double y, double angle) {
    const Vector3d wanted(0.1 * std::sin(angle), y - 0.1 * std::cos(angle), 0.0);
    return node_test::wait_for([&] {
      send(y, angle);
      advance();
      return (post(0) - wanted).norm() < 1e-9 &&
             (post(1) - wanted - Vector3d::UnitZ()).norm() < 1e-9;
    });
  }

  /// Both cables have been pushed, and what they have of momentum came from their posts.
  void expect_pushed() const {
    for (std::size_t i = 0; i < cables; ++i) {
      SCOPED_TRACE(posts[i]);
      Vector3d impulse = Vector3d::Zero();
      double strongest = 0.0;
      for (const auto& frame : seen) {
        EXPECT_GE(frame[i].distance(), post_radius + 0.95 * cable_radius - 1e-9);
        impulse -= time_step * frame[i].wrench;
        strongest = std::max(strongest, frame[i].wrench.norm());
      }
      ASSERT_GE(seen.size(), 3U);
      const Pushed& last = seen.back()[i];
      EXPECT_EQ(last.wrench, Vector3d::Zero()) << "it is away";
      EXPECT_GT(strongest, 0.0);
      const Vector3d momentum =
          (last.moment_of_mass() - seen[seen.size() - 2][i].moment_of_mass()) / time_step;
      EXPECT_GT(momentum.y(), 0.0);
      EXPECT_LT((impulse - momentum).norm(), 1e-3 * momentum.norm())
          << impulse.transpose() << " came, " << momentum.transpose() << " is there";
      EXPECT_GT(last.points[10].y(), 0.01);
    }
  }

  bool is_logged(const std::string& text) {
    return logs.wait_for([&](const rosgraph_msgs::Log& log) {
      return log.msg.find(text) != std::string::npos;
    }) != nullptr;
  }

  std::vector<std::array<Pushed, cables>> seen;  // by frame
  node_test::Recorder<fiber_proximity::ObstacleArray> obstacles{node, "/cable_sim/obstacles"};
  std::array<node_test::Recorder<geometry_msgs::WrenchStamped>, cables> wrenches{
      {{node, "/cable_sim/obstacle_wrenches/finger"}, {node, "/cable_sim/obstacle_wrenches/post"}}};
  node_test::Recorder<rosgraph_msgs::Log> logs{node, "/rosout"};

 private:
  tf2_ros::TransformBroadcaster broadcaster_;
  bool hears_wrenches_ = false;
};

TEST_F(SimObstaclesTest, LinksAndFramesPushCablesAndFeelThem) {
  for (int i = 1; i <= 25; ++i) {
    ASSERT_TRUE(go(0.005 * i, 0.0));
  }
  ASSERT_TRUE(go(0.0, 0.0));
  expect_pushed();
}

TEST_F(SimObstaclesTest, LinksAndFramesThatTurnPushCables) {
  for (int i = 1; i <= 30; ++i) {
    ASSERT_TRUE(go(0.0, 0.06 * i));
  }
  ASSERT_TRUE(go(0.0, 0.0));
  expect_pushed();
}

/// A prediction moves what follows a frame, as links of a robot do.
TEST_F(SimObstaclesTest, WhatFramesWillPushIsTold) {
  fiber_proximity::Predict::Request request;
  request.duration = 0.6;
  const auto middles = [&] {
    const auto told = call<fiber_proximity::Predict>("predict", request);
    EXPECT_TRUE(told.success) << told.message;
    EXPECT_EQ(told.touches.size(), request.trajectories.size());
    for (const auto& touch : told.touches) {
      EXPECT_EQ(touch.fiber, 1U);
      EXPECT_EQ(touch.type_b, fiber_proximity::Contact::OBJECT);
      EXPECT_EQ(told.object_names.at(touch.body_b), "post");
      EXPECT_GT(touch.first, 0.1);
    }
    const auto points = node_test::to_assembly(told.samples.at(0)).points();
    return std::array{points.at(nodes / 2), points.at(nodes + nodes / 2)};
  };
  for (const Vector3d& middle : middles()) {
    EXPECT_LT(std::abs(middle.y()), 1e-3);
  }
  fiber_proximity::HoldTrajectory& way = request.trajectories.emplace_back();
  way.frame = "tool";
  way.times = {0.0, 0.5};
  for (const double y : {0.0, 0.2}) {
    way.poses.push_back(
        fiber_proximity_ros::to_message(Eigen::Isometry3d(Eigen::Translation3d(0.0, y, 1.0))));
  }
  const auto pushed = middles();
  EXPECT_LT(std::abs(pushed[0].y()), 1e-3);
  EXPECT_GT(pushed[1].y(), 0.1 + post_radius);
  EXPECT_LT((post(1) - Vector3d(0.0, -0.1, 1.0)).norm(), 1e-9) << "the running scene stays";
}

TEST_F(SimObstaclesTest, PostsStayWhereTheirFramesAreLost) {
  ASSERT_TRUE(go(0.03, 0.0));
  const Vector3d before = post(0);
  const ros::SteadyTime start = ros::SteadyTime::now();
  while ((ros::SteadyTime::now() - start).toSec() < 1.0) {
    advance();
    EXPECT_EQ(post(0), before);
  }
  EXPECT_TRUE(is_logged("obstacle 'finger' stays where it is: nothing new of frame 'finger'"));
  EXPECT_TRUE(is_logged("obstacle 'post' stays where it is: nothing new of frame 'tool'"));
  ASSERT_TRUE(go(0.05, 0.0));
  EXPECT_TRUE(is_logged("obstacle 'finger' follows frame 'finger' again"));
}

/// Links that cannot be obstacles: a node of its own does not start.
class SimLinksTest : public OwnSceneTest {
 protected:
  ~SimLinksTest() override { node.deleteParam("/own_sim/frame_wait"); }

  /// The error of a node with this obstacle on line 12.
  std::string error_with(const std::string& obstacle) const {
    node.setParam("/own_sim/frame_wait", 2.0);
    write(
        scene(fiber("cable", "[0, 0, 0]", "[1, 0, 0]"), "  - stretch\n  - environment_contact\n") +
        "environment:\n  obstacles:\n    - " + obstacle + "\n");
    const fiber::test::ProcessResult result = run();
    EXPECT_EQ(result.exit_code, 2);
    return result.err;
  }

  void expect_error(const std::string& obstacle, const std::string& text) const {
    const std::string error = error_with(obstacle);
    EXPECT_NE(error.find(text), std::string::npos) << error;
    EXPECT_NE(error.find("scene.yaml:12: "), std::string::npos) << error;
  }
};

TEST_F(SimLinksTest, ThatAreNotThereAreErrorsOfTheScene) {
  const std::string field = "environment.obstacles[0].link is ";
  expect_error("{link: finger}",
               field + "finger: parameter /robot_description is not set, it must be the URDF");
  expect_error("{link: thumb, robot_description: other_robot}",
               field +
                   "thumb: parameter /other_robot: the robot 'gripper' has no such link, it "
                   "has: finger, palm");
  expect_error("{link: palm, robot_description: /other_robot}",
               field +
                   "palm: parameter /other_robot: this link of the robot 'gripper' has no "
                   "collision geometry, it needs some");
  expect_error("{link: finger, robot_description: rosdistro}",
               "the robot's description is no URDF of a robot");
  expect_error("{link: finger, robot_description: ~robot}", "'~robot' is not the name of a param");
  expect_error("{link: finger, robot_description: ''}", "the name of a parameter");
  expect_error("{link: finger, pose: {position: [0, 0, 1]}}", "has the unknown key 'pose'");
  expect_error("{link: finger, id: robot/finger, robot_description: other_robot}", "'robot/");
  expect_error("{id: box, robot_description: other_robot}", "unknown key 'robot_description'");
}

TEST_F(SimLinksTest, WhoseMeshesAreBadAreErrorsOfTheScene) {
  node.setParam("/bad_robot",
                "<robot name=\"bad\"><link name=\"hand\"><collision><geometry><mesh "
                "filename=\"file:///etc/passwd\"/></geometry></collision></link></robot>");
  expect_error("{link: hand, robot_description: bad_robot}",
               "link 'hand', collision 0: mesh 'file:///etc/passwd': it must be");
  node.deleteParam("/bad_robot");
}

TEST_F(SimLinksTest, WhoseFramesDoNotComeAreErrorsOfTheScene) {
  node.setParam("/lonely_robot",
                "<robot name=\"lonely\"><link name=\"nowhere\"><collision><geometry><sphere "
                "radius=\"0.1\"/></geometry></collision></link></robot>");
  expect_error("{link: nowhere, robot_description: lonely_robot}",
               "obstacle 'nowhere': nothing of frame 'nowhere' in 2.000000 s");
  node.deleteParam("/lonely_robot");
}

TEST_F(SimLinksTest, ThatFibresBeginInsideOfAreErrorsOfTheScene) {
  tf2_ros::StaticTransformBroadcaster broadcaster;
  broadcaster.sendTransform(transform_to("inside", {0.5, 0.0, 0.0}, 0.0));
  expect_error(
      "{id: box, primitives: [{type: box, dimensions: [0.1, 0.1, 0.1]}], motion: {frame: inside}}",
      "obstacle 'box', where frame 'inside' has it: segment ");
}

}  // namespace
