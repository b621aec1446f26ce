#pragma once

#include <sensor_msgs/PointCloud.h>
#include <sensor_msgs/PointCloud2.h>

#include "fiber_proximity/ros/fiber_buffer.hpp"

namespace fiber_proximity_ros {

/// The points of the cloud, in their order (row by row), as one fibre. Fields x, y and z may be
/// float32 or float64 at any offset; all others are ignored.
/// @throws std::invalid_argument for a cloud without x, y, z of these types, in big-endian order,
///         or with steps that do not fit its size
void to_chains(const sensor_msgs::PointCloud2& message, FiberBuffer& chains);

/// The points of the cloud, in their order, as one fibre.
void to_chains(const sensor_msgs::PointCloud& message, FiberBuffer& chains);

}  // namespace fiber_proximity_ros
