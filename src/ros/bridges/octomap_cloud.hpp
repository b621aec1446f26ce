#pragma once

#include <octomap_msgs/Octomap.h>
#include <sensor_msgs/PointCloud2.h>

#include <cstddef>

namespace fiber_proximity_ros {

/// Cells that a map may occupy: 48 MB of points.
inline constexpr std::size_t most_occupied_cells = 4'000'000;

/// The centres of all cells of the finest resolution that are occupied, with the map's header.
/// @throws std::invalid_argument as read_occupied_leaves, and for more cells than the above
sensor_msgs::PointCloud2 to_cloud(const octomap_msgs::Octomap& map);

}  // namespace fiber_proximity_ros
