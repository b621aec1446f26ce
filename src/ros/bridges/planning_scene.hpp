#pragma once

#include <moveit_msgs/PlanningScene.h>

#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/Obstacle.h"

namespace fiber_proximity_ros {

/// The objects of the scene's world, in their order. One that is not a difference from another
/// scene is all there is: the removal of all obstacles comes first.
std::vector<fiber_proximity::Obstacle> to_obstacles(const moveit_msgs::PlanningScene& scene);

/// The octomap of the scene's world, in the frame of the scene's; none if it has no data or its
/// origin is displaced, for which Octomap has no field.
std::optional<octomap_msgs::Octomap> octomap_of(const moveit_msgs::PlanningScene& scene);

/// What an object, or a scene and its objects, ask for that has no counterpart in the environment.
std::vector<std::string> without_counterpart(const moveit_msgs::CollisionObject& object);
std::vector<std::string> without_counterpart(const moveit_msgs::PlanningScene& scene);

}  // namespace fiber_proximity_ros
