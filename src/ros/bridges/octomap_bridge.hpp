#pragma once

#include <octomap_msgs/Octomap.h>
#include <ros/node_handle.h>

#include "src/ros/inputs/refusal_log.hpp"

namespace fiber_proximity_ros {

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
  RefusalLog refusals_;
  ros::Subscriber subscriber_;  // last: its callback uses the above
};

}  // namespace fiber_proximity_ros
