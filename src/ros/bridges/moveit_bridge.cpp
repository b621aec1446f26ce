#include "src/ros/bridges/moveit_bridge.hpp"

#include <ros/console.h>

#include <utility>

#include "src/ros/bridges/collision_object.hpp"
#include "src/ros/bridges/planning_scene.hpp"

namespace fiber_proximity_ros {
namespace {

/// Unbounded: what is too much is said here, roscpp would drop it without a word.
constexpr std::uint32_t queue_size = 0;

/// [s] How often a service that was not there is tried again, and how often that is logged.
constexpr double retry_period = 0.2;
constexpr double warning_period = 5.0;

}  // namespace

MoveitBridge::MoveitBridge(ros::NodeHandle node)
    : service_(node.resolveName("proximity/apply_obstacles")),
      client_(node.serviceClient<fiber_proximity::ApplyObstacles>("proximity/apply_obstacles")),
      octomap_publisher_(node.advertise<octomap_msgs::Octomap>("octomap", 1, true)),
      object_subscriber_(
          node.subscribe("collision_object", queue_size, &MoveitBridge::receive_object, this)),
      scene_subscriber_(
          node.subscribe("planning_scene", queue_size, &MoveitBridge::receive_scene, this)),
      timer_(node.createWallTimer(ros::WallDuration(retry_period),
                                  [this](const ros::WallTimerEvent&) { apply_waiting(); })) {}

void MoveitBridge::receive_object(const moveit_msgs::CollisionObject& object) {
  const std::string topic = object_subscriber_.getTopic();
  warn_of(topic, without_counterpart(object));
  apply(topic, {to_obstacle(object)});
}

void MoveitBridge::receive_scene(const moveit_msgs::PlanningScene& scene) {
  const std::string topic = scene_subscriber_.getTopic();
  warn_of(topic, without_counterpart(scene));
  publish_octomap(scene);
  apply(topic, to_obstacles(scene));
}

void MoveitBridge::publish_octomap(const moveit_msgs::PlanningScene& scene) {
  if (const std::optional<octomap_msgs::Octomap> map = octomap_of(scene)) {
    octomap_header_ = map->header;
    octomap_publisher_.publish(*map);
  } else if (octomap_header_ && scene.is_diff == 0) {
    octomap_msgs::Octomap empty;
    empty.header = *std::exchange(octomap_header_, std::nullopt);
    empty.id = "OcTree";
    empty.resolution = 1.0;
    octomap_publisher_.publish(empty);
  }
}

void MoveitBridge::apply(const std::string& topic,
                         std::vector<fiber_proximity::Obstacle> obstacles) {
  if (obstacles.empty()) {  // most differences of scenes are about the robot alone
    return;
  }
  if (waiting_.size() >= most_waiting) {
    ROS_ERROR_STREAM("'" << topic << "': message lost, as " << most_waiting
                         << " wait for the service " << service_
                         << " already; its first object is '" << obstacles.front().id << "'");
    return;
  }
  waiting_.push_back({topic, {}});
  waiting_.back().request.obstacles = std::move(obstacles);
  if (waiting_.size() == 1) {  // otherwise the timer is at it
    apply_waiting();
  }
}

void MoveitBridge::apply_waiting() {
  while (!waiting_.empty()) {
    Change& change = waiting_.front();
    fiber_proximity::ApplyObstacles::Response response;
    if (!client_.call(change.request, response)) {
      ROS_WARN_STREAM_THROTTLE(warning_period,
                               waiting_.size() << " message(s) wait for the service " << service_);
      return;
    }
    if (response.success == 0) {
      ROS_ERROR_STREAM("'" << change.topic << "': message refused by " << service_ << ": "
                           << response.message);
    }
    waiting_.pop_front();
  }
}

void MoveitBridge::warn_of(const std::string& topic,
                           const std::vector<std::string>& without_counterpart) {
  for (const std::string& what : without_counterpart) {
    if (warned_of_.insert(what).second) {
      ROS_WARN_STREAM("'" << topic << "': " << what
                          << " have no counterpart and are left out, here and from now on");
    }
  }
}

}  // namespace fiber_proximity_ros
