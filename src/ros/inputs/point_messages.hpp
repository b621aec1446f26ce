#pragma once

#include <geometry_msgs/PoseArray.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/PointCloud.h>
#include <sensor_msgs/PointCloud2.h>

#include "fiber_proximity/ros/conversions.hpp"

namespace fiber_proximity_ros {

// Messages of points, each read as one fibre in the order of its points.

/// The points of the cloud, in their order (row by row), as one fibre. Fields x, y and z may be
/// float32 or float64 at any offset; all others are ignored.
/// @throws std::invalid_argument for a cloud without x, y, z of these types, in big-endian order,
///         or with steps that do not fit its size
void to_chains(const sensor_msgs::PointCloud2& message, FiberBuffer& fibers);

/// The points of the cloud, in their order, as one fibre.
void to_chains(const sensor_msgs::PointCloud& message, FiberBuffer& fibers);

/// The positions of the poses as one fibre; orientations are ignored.
void to_chains(const geometry_msgs::PoseArray& message, FiberBuffer& fibers);

/// The positions of the poses as one fibre; stamps and orientations of the poses are ignored.
/// @throws std::invalid_argument for a pose in a frame other than the path's
void to_chains(const nav_msgs::Path& message, FiberBuffer& fibers);

}  // namespace fiber_proximity_ros
