// Obstacles that come to the simulation by a topic, through the real graph.
#include <geometry_msgs/WrenchStamped.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fiber_proximity/ObstacleArray.h"
#include "fiber_proximity/Predict.h"
#include "fiber_proximity/ros/conversions.hpp"
#include "test/ros/messages.hpp"
#include "test/ros/own_scene_fixture.hpp"

namespace {

using Eigen::Vector3d;
using fiber_proximity::Obstacle;
using fiber_proximity_ros::to_vector;

constexpr double ball_radius = 0.05;
constexpr double frame_time = 1.0 / 60.0;  // [s]

/// A ball. Its stamp is zero, which means now.
Obstacle ball_message(const std::string& id, std::int8_t operation, double y) {
  Obstacle obstacle;
  obstacle.id = id;
  obstacle.operation = operation;
  obstacle.pose.position.x = 0.5;
  obstacle.pose.position.y = y;
  obstacle.pose.orientation.w = 1.0;
  if (operation == Obstacle::ADD || operation == Obstacle::APPEND) {
    obstacle.primitives.emplace_back();
    obstacle.primitives.back().type = shape_msgs::SolidPrimitive::SPHERE;
    obstacle.primitives.back().dimensions = {ball_radius};
  }
  return obstacle;
}

Obstacle removal_message(const std::string& id) {
  Obstacle obstacle;
  obstacle.id = id;
  obstacle.operation = Obstacle::REMOVE;
  return obstacle;
}

/// A cable along x, from 0 to 1 m, that nothing holds, and a node that moves it.
class SimTopicTest : public OwnSceneTest {
 protected:
  void SetUp() override {
    node.setParam("/own_sim/frame_wait", 0.2);
    write(scene(fiber("cable", "[0, 0, 0]", "[1, 0, 0]"),
                "  - stretch\n  - bend\n  - environment_contact\n  - friction\n") +
          "environment: {obstacles: [{id: floor, half_spaces: [{coef: [0, 0, 1, 1]}]}]}\n");
    std::vector<std::string> arguments = command();
    arguments.emplace_back("obstacles:=own_obstacles");
    own_sim = std::make_unique<node_test::RunningNode>(arguments, folder_.path("output.txt"));
    publisher = node_test::advertise<fiber_proximity::ObstacleArray>(node, "/own_obstacles");
    ASSERT_TRUE(node_test::wait_for([this] {
      return publisher.getNumSubscribers() > 0 && !obstacles.messages.empty() &&
             !fibers.messages.empty();
    }));
  }
  void TearDown() override { node.deleteParam("/own_sim/frame_wait"); }

  void publish(const std::vector<Obstacle>& changes) const {
    fiber_proximity::ObstacleArray message;
    message.obstacles = changes;
    publisher.publish(message);
  }

  /// One frame, of which all is heard.
  void advance() {
    const std::size_t seen = fibers.messages.size();
    const std::size_t told = obstacles.messages.size();
    const bool moves = moving;
    ASSERT_TRUE(step(1).success);
    ASSERT_TRUE(node_test::wait_for([&] {
      return fibers.messages.size() > seen && (!moves || obstacles.messages.size() > told);
    }));
  }

  /// Null where the last message has none of this name.
  const Obstacle* find(const std::string& id) const {
    const auto& all = obstacles.messages.back()->obstacles;
    const auto found = std::find_if(all.begin(), all.end(), [&id](const Obstacle& each) {
      return each.id == id && each.operation == Obstacle::ADD;
    });
    return found == all.end() ? nullptr : &*found;
  }
  double y_of(const std::string& id) const {
    const Obstacle* const found = find(id);
    return found == nullptr ? std::nan("") : found->pose.position.y;
  }

  bool comes(const std::string& id) {
    const bool has_come = node_test::wait_for([&] {
      advance();
      return find(id) != nullptr;
    });
    moving = has_come;
    return has_come;
  }

  /// Frame by frame until the ball is there. No point of the cable is ever inside of it.
  bool arrives(const std::string& id, double y) {
    return node_test::wait_for([&] {
      advance();
      const Vector3d ball = to_vector(find(id)->pose.position);
      for (const Vector3d& point : points()) {
        EXPECT_GT((point - ball).norm(), ball_radius + 0.95 * 0.005 - 1e-9);
      }
      return std::abs(y_of(id) - y) < 1e-9;
    });
  }

  std::vector<Vector3d> points() const {
    return node_test::to_assembly(*fibers.messages.back()).points();
  }

  /// How many warnings have this text.
  std::size_t warnings(const std::string& text) const {
    const std::string output = own_sim->output();
    std::size_t count = 0;
    for (std::size_t at = output.find(text); at != std::string::npos;
         at = output.find(text, at + 1)) {
      ++count;
    }
    return count;
  }

  /// What is refused is said once, and leaves all as it is.
  void expect_refused(const std::vector<Obstacle>& changes, const std::string& text) {
    SCOPED_TRACE(text);
    const std::string warning = "obstacles of /own_obstacles are refused: " + text;
    const std::size_t before = warnings(warning);
    publish(changes);
    EXPECT_TRUE(node_test::wait_for([&] {
      advance();
      return warnings(warning) > before;
    })) << own_sim->output();
    advance();
    EXPECT_EQ(warnings(warning), before + 1) << own_sim->output();
    EXPECT_EQ(obstacles.messages.back()->obstacles.size(), moving ? 2U : 1U);
  }

  bool moving = false;  // whether obstacles are told in each frame
  std::unique_ptr<node_test::RunningNode> own_sim;
  ros::Publisher publisher;
  node_test::Recorder<fiber_proximity::FiberArray> fibers{node, "/own_sim/fibers"};
  node_test::Recorder<fiber_proximity::ObstacleArray> obstacles{node, "/own_sim/obstacles"};
  node_test::Recorder<geometry_msgs::WrenchStamped> wrenches{node,
                                                             "/own_sim/obstacle_wrenches/ball"};
};

TEST_F(SimTopicTest, ABallComesPushesTheCableAndGoes) {
  Obstacle ball = ball_message("ball", Obstacle::ADD, -0.2);
  ball.header.stamp = ros::Time::now() - ros::Duration(1.0);
  publish({ball});
  ASSERT_TRUE(comes("ball"));
  EXPECT_EQ(y_of("ball"), -0.2);
  ASSERT_TRUE(node_test::wait_for([this] {
    advance();
    return !wrenches.messages.empty();
  }));
  EXPECT_EQ(wrenches.messages.back()->wrench.force.y, 0.0);
  // Half a second later it is 40 cm further: 0.8 m/s.
  const ros::Time begin = ball.header.stamp;
  ball = ball_message("ball", Obstacle::MOVE, 0.2);
  ball.header.stamp = begin + ros::Duration(0.5);
  publish({ball});
  ASSERT_TRUE(arrives("ball", 0.2));
  std::vector<double> way;
  for (const auto& message : obstacles.messages) {
    const auto& told = message->obstacles;
    const double y = told.size() > 1 ? told[1].pose.position.y : -0.2;
    if (way.empty() || std::abs(y - way.back()) > 1e-9) {
      way.push_back(y);
    }
  }
  EXPECT_EQ(way.size(), 31U) << "of the frames in half a second";
  for (std::size_t i = 1; i < way.size(); ++i) {
    EXPECT_NEAR(way[i] - way[i - 1], 0.8 * frame_time, 1e-9);
  }
  EXPECT_LT(std::min_element(
                wrenches.messages.begin(), wrenches.messages.end(),
                [](const auto& a, const auto& b) { return a->wrench.force.y < b->wrench.force.y; })
                ->get()
                ->wrench.force.y,
            0.0);
  EXPECT_GT(points()[10].y(), 0.2);

  fiber_proximity::Predict::Request request;
  request.duration = 0.1;
  const auto names = call<fiber_proximity::Predict>("predict", request).object_names;
  EXPECT_EQ(names, (std::vector<std::string>{"floor", "ball"}));

  moving = false;  // no frame tells of obstacles once the last has gone, which may be at once
  publish({removal_message("ball")});
  ASSERT_TRUE(node_test::wait_for([this] {
    advance();
    return find("ball") == nullptr;
  }));
  const auto* const told = obstacles.find([](const auto& message) {
    return message.obstacles.size() == 1 && message.obstacles[0].id == "ball" &&
           message.obstacles[0].operation == Obstacle::REMOVE;
  });
  EXPECT_NE(told, nullptr) << "a message of its own";
  const std::size_t count = wrenches.messages.size();
  advance();
  advance();
  EXPECT_EQ(wrenches.messages.size(), count);
  EXPECT_EQ(warnings("refused"), 0U) << own_sim->output();
}

/// A long bar whose tip would be at 190 m/s by its stamps.
TEST_F(SimTopicTest, NothingTurnsFasterThanItMayMove) {
  Obstacle bar = ball_message("bar", Obstacle::ADD, -5.0);
  bar.primitives[0].type = shape_msgs::SolidPrimitive::BOX;
  bar.primitives[0].dimensions = {4.0, 0.02, 0.02};
  bar.header.stamp = ros::Time::now() - ros::Duration(1.0);
  publish({bar});
  ASSERT_TRUE(comes("bar"));
  Obstacle turned = ball_message("bar", Obstacle::MOVE, -5.0);
  turned.pose.orientation.z = turned.pose.orientation.w = std::sqrt(0.5);
  turned.header.stamp = bar.header.stamp + ros::Duration(frame_time);
  publish({turned});
  double angle = 0.0;
  double largest = 0.0;  // turn in a frame
  ASSERT_TRUE(node_test::wait_for([&] {
    advance();
    const double before = angle;
    angle = 2.0 * std::asin(find("bar")->pose.orientation.z);
    largest = std::max(largest, angle - before);
    return std::abs(angle - 0.5 * M_PI) < 1e-6;
  }));
  EXPECT_LE(2.0 * largest, 1.01 * 5.0 * frame_time);
  EXPECT_GT(2.0 * largest, 0.9 * 5.0 * frame_time);
}

TEST_F(SimTopicTest, ShapesAreAddedAndAllRemoved) {
  tf2_ros::StaticTransformBroadcaster broadcaster;
  broadcaster.sendTransform(test_messages::transform("table", {0.0, 0.0, 0.5}));
  Obstacle other = ball_message("other", Obstacle::APPEND, 0.0);
  other.header.frame_id = "table";
  ASSERT_TRUE(node_test::wait_for([&] {  // until tf has come
    publish({ball_message("ball", Obstacle::ADD, -0.2), other});
    advance();
    return find("other") != nullptr;
  }));
  moving = true;
  EXPECT_EQ(find("other")->pose.position.z, 0.5);
  EXPECT_EQ(find("other")->header.frame_id, "world");
  Obstacle more = ball_message("ball", Obstacle::APPEND, 7.0);
  more.primitive_poses.resize(1);
  more.primitive_poses[0].position.z = 0.3;
  more.primitive_poses[0].orientation.w = 1.0;
  publish({more});
  ASSERT_TRUE(node_test::wait_for([&] {
    advance();
    return find("ball")->primitives.size() == 2;
  }));
  EXPECT_EQ(y_of("ball"), -0.2) << "its pose stays";
  moving = false;  // as above
  publish({removal_message("")});
  ASSERT_TRUE(node_test::wait_for([&] {
    advance();
    return find("ball") == nullptr && find("floor") != nullptr;  // that is the scene's
  }));
  EXPECT_EQ(find("other"), nullptr);
}

TEST_F(SimTopicTest, TheSameBallAgainPushesRatherThanAppears) {
  publish({ball_message("ball", Obstacle::ADD, -0.06)});
  ASSERT_TRUE(comes("ball"));
  publish({ball_message("ball", Obstacle::ADD, 0.06)});  // the cable is between
  ASSERT_TRUE(arrives("ball", 0.06));
  EXPECT_GT(points()[10].y(), 0.1);
  EXPECT_EQ(warnings("refused"), 0U) << own_sim->output();
}

TEST_F(SimTopicTest, WhatCannotBeIsRefusedByName) {
  expect_refused({ball_message("inside", Obstacle::ADD, 0.0)}, "obstacle 'inside': segment ");
  expect_refused({ball_message("floor", Obstacle::ADD, 1.0)},
                 "obstacle 'floor': the scene has an obstacle of this name");
  expect_refused({removal_message("floor")}, "obstacle 'floor': the scene has an");
  expect_refused({ball_message("nothing", Obstacle::MOVE, 1.0)},
                 "object 'nothing': there is no object of this name");
  Obstacle ball = ball_message("ball", Obstacle::ADD, 1.0);
  ball.pose.position.x = std::numeric_limits<double>::quiet_NaN();
  expect_refused({ball}, "obstacle 'ball': pose: ");
  ball = ball_message("flat", Obstacle::ADD, 1.0);
  ball.primitives[0].dimensions[0] = -1.0;
  expect_refused({ball}, "object 'flat', shape 0: radius");
  ball = ball_message("torus", Obstacle::ADD, 1.0);
  ball.primitives[0].type = 77;
  expect_refused({ball}, "obstacle 'torus': primitive 0: type is 77");
  ball = ball_message("away", Obstacle::ADD, 1.0);
  ball.header.frame_id = "nowhere";
  expect_refused({ball}, "obstacle 'away': ");
  ball = ball_message("odd", 9, 1.0);
  expect_refused({ball}, "obstacle 'odd': operation is 9");
  // All of a message or nothing.
  expect_refused(
      {ball_message("good", Obstacle::ADD, 1.0), ball_message("bad", Obstacle::ADD, 0.0)},
      "obstacle 'bad': segment ");
  publish({ball_message("ball", Obstacle::ADD, 1.0)});
  ASSERT_TRUE(comes("ball"));
  ball = ball_message("ball", Obstacle::APPEND, 0.0);
  ball.primitive_poses.resize(1);
  ball.primitive_poses[0].position.y = -1.0;
  ball.primitive_poses[0].orientation.w = 1.0;
  expect_refused({ball}, "obstacle 'ball': segment ");
  EXPECT_EQ(find("ball")->primitives.size(), 1U);
}

TEST_F(SimTopicTest, ASceneThatBeginsAgainHasThemWhereThereIsRoom) {
  publish({ball_message("ball", Obstacle::ADD, -0.1), ball_message("far", Obstacle::ADD, 2.0)});
  ASSERT_TRUE(comes("ball"));
  publish({ball_message("ball", Obstacle::MOVE, 0.0)});
  ASSERT_TRUE(arrives("ball", 0.0));
  ASSERT_TRUE(call<std_srvs::Trigger>("reset").success);
  ASSERT_TRUE(
      node_test::wait_for([&] { return find("ball") == nullptr && find("far") != nullptr; }));
  EXPECT_EQ(warnings("obstacles of /own_obstacles are removed: obstacle 'ball': segment "), 1U)
      << own_sim->output();
  // Its name is free again.
  publish({ball_message("ball", Obstacle::ADD, -0.1)});
  EXPECT_TRUE(comes("ball"));
}

}  // namespace
