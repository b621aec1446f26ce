#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <future>
#include <map>
#include <memory>
#include <string>

#include "fiber_proximity/ApplyObstacles.h"
#include "src/ros/environment/environment_inputs.hpp"
#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"
#include "test/support/error_of.hpp"

namespace environment_test {

using fiber_proximity::Obstacle;
using fiber_proximity_ros::EnvironmentInputs;

/// EnvironmentInputs with parameters and topics of its own, in the frame `world`.
class EnvironmentFixture : public ::testing::Test {
 protected:
  EnvironmentFixture() { own.deleteParam(""); }

  fiber_proximity_ros::EnvironmentOptions options() const {
    return fiber_proximity_ros::read_environment_options(node, own);
  }

  void start() {
    inputs = std::make_unique<EnvironmentInputs>(node, own, options(), frame, [] {});
  }

  /// Updates and handles callbacks until the condition holds.
  bool wait_for(const std::function<bool()>& condition) const {
    return node_test::wait_for([&] {
      inputs->update(ros::Time::now());
      return condition();
    });
  }

  template <class Message>
  ros::Publisher advertise(const std::string& topic) {
    const ros::Publisher publisher = node_test::advertise<Message>(own, topic);
    EXPECT_TRUE(node_test::wait_for([&] { return publisher.getNumSubscribers() > 0; }));
    return publisher;
  }

  template <class Service>
  typename Service::Response call(const std::string& name,
                                  const typename Service::Request& request) const {
    Service service;
    service.request = request;
    // Answered by this thread, so asked by another.
    auto called = std::async(std::launch::async, [&] {
      return node_test::call_service_alone(own.resolveName(name), service);
    });
    EXPECT_TRUE(node_test::wait_for(
        [&] { return called.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }));
    EXPECT_TRUE(called.get());
    return service.response;
  }

  std::string apply(const std::vector<Obstacle>& obstacles) const {
    fiber_proximity::ApplyObstacles::Request request;
    request.obstacles = obstacles;
    const auto response = call<fiber_proximity::ApplyObstacles>("apply_obstacles", request);
    EXPECT_EQ(response.success != 0, response.message.empty());
    return response.message;
  }

  static geometry_msgs::TransformStamped transform(const std::string& frame, double x) {
    return test_messages::transform(frame, {x, 0.0, 0.0});
  }

  /// A ball of 0.5 m, at this place along x.
  static Obstacle ball(const std::string& id, double x = 0.0, const std::string& frame = "") {
    return test_messages::ball(id, x, 0.5, frame);
  }

  static Obstacle removal(const std::string& id) {
    Obstacle obstacle;
    obstacle.id = id;
    obstacle.operation = Obstacle::REMOVE;
    return obstacle;
  }

  using Places = std::map<std::string, double>;

  /// Name and x of all there is.
  Places places() const {
    Places places;
    for (const fiber::EnvironmentObject& object : inputs->environment()->objects()) {
      places[object.name] = object.pose.translation().x();
    }
    return places;
  }

  /// What is unknown now, each on one line.
  std::vector<std::string> unknown() const {
    std::vector<std::string> texts;
    for (const fiber_proximity_ros::Unknown& unknown : inputs->unknown(true)) {
      texts.push_back(unknown.what + ": " + unknown.why);
    }
    return texts;
  }

  fiber_proximity::InputStatistics statistics_of(const std::string& topic) const {
    for (const auto& statistics : inputs->statistics(ros::Time::now())) {
      if (statistics.topic == own.resolveName(topic)) {
        return statistics;
      }
    }
    ADD_FAILURE() << "no statistics of " << topic;
    return {};
  }

  ros::NodeHandle node;
  ros::NodeHandle own{std::string("~") +
                      ::testing::UnitTest::GetInstance()->current_test_info()->name()};
  tf2_ros::StaticTransformBroadcaster static_transforms;
  fiber_proximity_ros::FixedFrame frame{"world", node};
  std::unique_ptr<EnvironmentInputs> inputs;
};

/// The same, with its topic of obstacles.
class EnvironmentInputsTest : public EnvironmentFixture {
 protected:
  void start_with_topic() {
    start();
    publisher_ = advertise<fiber_proximity::ObstacleArray>("obstacles");
  }

  void publish(const std::vector<Obstacle>& obstacles) {
    fiber_proximity::ObstacleArray message;
    message.obstacles = obstacles;
    publisher_.publish(message);
  }

  /// Calls the service while this thread goes on.
  std::future<std::string> apply_meanwhile(const std::vector<Obstacle>& obstacles) const {
    return std::async(std::launch::async, [this, obstacles] {
      fiber_proximity::ApplyObstacles service;
      service.request.obstacles = obstacles;
      EXPECT_TRUE(node_test::call_service_alone(own.resolveName("apply_obstacles"), service));
      return service.response.message;
    });
  }

  ros::Publisher publisher_;
};

}  // namespace environment_test
