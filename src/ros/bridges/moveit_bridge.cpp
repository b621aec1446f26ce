#include "src/ros/bridges/moveit_bridge.hpp"

#include <ros/console.h>

#include <algorithm>
#include <utility>

namespace fiber_proximity_ros {
namespace {

using fiber_proximity::Obstacle;
using moveit_msgs::CollisionObject;
using moveit_msgs::PlanningScene;
using Names = std::vector<std::string>;

/// True unless the pose is the identity, or zero throughout, which nobody filled in.
bool is_displaced(const geometry_msgs::Pose& pose) {
  const auto& p = pose.position;
  const auto& q = pose.orientation;
  return p.x != 0.0 || p.y != 0.0 || p.z != 0.0 || q.x != 0.0 || q.y != 0.0 || q.z != 0.0;
}

bool changes_links(const PlanningScene& scene) {
  return std::any_of(scene.link_padding.begin(), scene.link_padding.end(),
                     [](const auto& link) { return link.padding != 0.0; }) ||
         std::any_of(scene.link_scale.begin(), scene.link_scale.end(),
                     [](const auto& link) { return link.scale != 1.0; });
}

/// An unbounded queue. This bridge tells of messages it drops; roscpp would not.
constexpr std::uint32_t queue_size = 0;

/// [s] The time between two tries of a service that is not there, and between two logs of that.
constexpr double retry_period = 0.2;
constexpr double warning_period = 5.0;

}  // namespace

static_assert(int{Obstacle::ADD} == int{CollisionObject::ADD} &&
              int{Obstacle::REMOVE} == int{CollisionObject::REMOVE} &&
              int{Obstacle::APPEND} == int{CollisionObject::APPEND} &&
              int{Obstacle::MOVE} == int{CollisionObject::MOVE});

Obstacle to_obstacle(const CollisionObject& object) {
  Obstacle obstacle;
  obstacle.header.frame_id = object.header.frame_id;
  obstacle.pose = object.pose;
  obstacle.id = object.id;
  obstacle.primitives = object.primitives;
  obstacle.primitive_poses = object.primitive_poses;
  obstacle.meshes = object.meshes;
  obstacle.mesh_poses = object.mesh_poses;
  obstacle.planes = object.planes;
  obstacle.plane_poses = object.plane_poses;
  obstacle.operation = object.operation;
  return obstacle;
}

std::vector<Obstacle> to_obstacles(const PlanningScene& scene) {
  std::vector<Obstacle> obstacles;
  if (scene.is_diff == 0) {
    obstacles.emplace_back();
    obstacles.back().operation = Obstacle::REMOVE;
  }
  for (const CollisionObject& object : scene.world.collision_objects) {
    obstacles.push_back(to_obstacle(object));
  }
  return obstacles;
}

std::optional<octomap_msgs::Octomap> octomap_of(const PlanningScene& scene) {
  const octomap_msgs::OctomapWithPose& placed = scene.world.octomap;
  if (placed.octomap.data.empty() || is_displaced(placed.origin)) {
    return std::nullopt;
  }
  octomap_msgs::Octomap map = placed.octomap;
  map.header = placed.header;  // MoveIt leaves the map's own empty
  return map;
}

Names without_counterpart(const CollisionObject& object) {
  return object.subframe_names.empty() ? Names{} : Names{"subframes of objects"};
}

Names without_counterpart(const PlanningScene& scene) {
  Names found;
  if (!scene.robot_state.attached_collision_objects.empty()) {
    found.emplace_back("objects attached to the robot");
  }
  if (changes_links(scene)) {
    found.emplace_back("padding and scale of links");
  }
  if (!scene.world.octomap.octomap.data.empty() && is_displaced(scene.world.octomap.origin)) {
    found.emplace_back("octomaps with a displaced origin");
  }
  const auto& objects = scene.world.collision_objects;
  if (std::any_of(objects.begin(), objects.end(),
                  [](const auto& object) { return !object.subframe_names.empty(); })) {
    found.emplace_back("subframes of objects");
  }
  return found;
}

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

void MoveitBridge::receive_object(const CollisionObject& object) {
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
  if (waiting_.size() >= max_waiting) {
    ROS_ERROR_STREAM("'" << topic << "': message lost, as " << max_waiting
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

void MoveitBridge::warn_of(const std::string& topic, const Names& without_counterpart) {
  for (const std::string& what : without_counterpart) {
    if (warned_of_.insert(what).second) {
      ROS_WARN_STREAM("'" << topic << "': " << what
                          << " have no counterpart and are left out, here and from now on");
    }
  }
}

}  // namespace fiber_proximity_ros
