#pragma once

#include <geometry_msgs/Pose.h>

#include <cstddef>
#include <string>

#include "fiber_proximity/Obstacle.h"
#include "fiber_proximity/environment/world.hpp"

namespace fiber_proximity_ros {

/// @throws std::invalid_argument as fiber::make_pose
Eigen::Isometry3d to_pose(const geometry_msgs::Pose& message);

/// Makes a change of the world of a message, still in the message's frame. A REMOVE of an
/// empty id, which means all obstacles, is left to those who know them.
/// @throws std::invalid_argument naming the obstacle, what is wrong with it and what is allowed
fiber::ObjectChange to_change(const fiber_proximity::Obstacle& obstacle);

/// The removal of an object.
fiber::ObjectChange removal_of(const std::string& name);

/// The message that adds an object: to_change() makes it the same object again, with its shapes by
/// kind.
/// @param object   without octrees, which have no message
/// @param frame_id in which the object's pose is
fiber_proximity::Obstacle to_obstacle(const fiber::EnvironmentObject& object,
                                      const std::string& frame_id);

/// Whether building meshes of so many triangles would keep the node from answering for longer than
/// a small query takes; then it is left to a Worker.
inline bool is_large_mesh(std::size_t triangles) {
  constexpr std::size_t max_at_once = 500;  // about 2 ms
  return triangles > max_at_once;
}

}  // namespace fiber_proximity_ros
