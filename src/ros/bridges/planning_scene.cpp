#include "src/ros/bridges/planning_scene.hpp"

#include <algorithm>

#include "src/ros/bridges/collision_object.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber_proximity::Obstacle;
using moveit_msgs::PlanningScene;

/// Zero throughout is a pose that nobody filled in.
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

}  // namespace

std::vector<Obstacle> to_obstacles(const PlanningScene& scene) {
  std::vector<Obstacle> obstacles;
  if (scene.is_diff == 0) {
    obstacles.emplace_back();
    obstacles.back().operation = Obstacle::REMOVE;
  }
  for (const moveit_msgs::CollisionObject& object : scene.world.collision_objects) {
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

std::vector<std::string> without_counterpart(const moveit_msgs::CollisionObject& object) {
  if (object.subframe_names.empty()) {
    return {};
  }
  return {"subframes of objects"};
}

std::vector<std::string> without_counterpart(const PlanningScene& scene) {
  std::vector<std::string> found;
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

}  // namespace fiber_proximity_ros
