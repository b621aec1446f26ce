#pragma once

#include <geometry_msgs/PoseArray.h>
#include <nav_msgs/Path.h>

#include "fiber_proximity/ros/fiber_buffer.hpp"

namespace fiber_proximity_ros {

/// The positions of the poses as one fibre; orientations are ignored.
void to_chains(const geometry_msgs::PoseArray& message, FiberBuffer& chains);

/// The positions of the poses as one fibre; stamps and orientations of the poses are ignored.
/// @throws std::invalid_argument for a pose in a frame other than the path's
void to_chains(const nav_msgs::Path& message, FiberBuffer& chains);

}  // namespace fiber_proximity_ros
