#pragma once

#include <geometry_msgs/Pose.h>

#include <Eigen/Geometry>

namespace fiber_proximity_ros {

/// Pose of an obstacle or a shape. A quaternion a little off unit length is normalised: its squared
/// length may be wrong by 0.01, as tf2 has it (tf2/src/buffer_core.cpp). A pose that is zero
/// throughout, as messages are that nobody filled in, is the identity.
/// @throws std::invalid_argument naming the value and what is allowed
Eigen::Isometry3d to_pose(const geometry_msgs::Pose& message);

}  // namespace fiber_proximity_ros
