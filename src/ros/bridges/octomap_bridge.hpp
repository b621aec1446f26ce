#pragma once

#include <octomap_msgs/Octomap.h>
#include <ros/node_handle.h>
#include <sensor_msgs/PointCloud2.h>

#include <cstddef>

#include "src/ros/inputs/message_log.hpp"

namespace fiber_proximity_ros {

/// Cells that a map may occupy: 48 MB of points.
inline constexpr std::size_t max_occupied_cells = 4'000'000;

/// The centres of all cells of the finest resolution that are occupied, with the map's header.
/// Reads OcTree, ColorOcTree and OcTreeStamped, binary or full.
/// @throws std::invalid_argument for another type of octree, a resolution or data that are none,
/// and
///         for more cells than the above
sensor_msgs::PointCloud2 to_cloud(const octomap_msgs::Octomap& map);

/// Octomaps as clouds that proximity_node takes: subscribes to `octomap`, publishes the centres of
/// the occupied cells on `cloud`, latched. A map that cannot be read is an error in the log.
class OctomapBridge {
 public:
  explicit OctomapBridge(ros::NodeHandle node);
  OctomapBridge(const OctomapBridge&) = delete;
  OctomapBridge& operator=(const OctomapBridge&) = delete;

 private:
  void receive(const octomap_msgs::Octomap& map);

  ros::Publisher publisher_;
  MessageLog log_;
  ros::Subscriber subscriber_;  // last: its callback uses the above
};

}  // namespace fiber_proximity_ros
