#pragma once

#include <ros/node_handle.h>

#include <optional>

#include "src/ros/environment/cloud_cells.hpp"

namespace fiber_proximity_ros {

/// Reads the parameters ~cloud/resolution, ~cloud/box/min, ~cloud/box/max and ~cloud/decay; those
/// that are absent keep their defaults. ~cloud may also just be true.
/// @returns none if there is no parameter ~cloud, or if it is false: then no cloud is wanted
/// @throws std::invalid_argument naming the parameter, its value and what is allowed
std::optional<CloudOptions> read_cloud_options(const ros::NodeHandle& private_node);

}  // namespace fiber_proximity_ros
