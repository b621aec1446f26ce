#include "src/ros/bridges/octomap_bridge.hpp"

#include <sensor_msgs/PointCloud2.h>

#include <stdexcept>

#include "src/ros/bridges/octomap_cloud.hpp"

namespace fiber_proximity_ros {

OctomapBridge::OctomapBridge(ros::NodeHandle node)
    : publisher_(node.advertise<sensor_msgs::PointCloud2>("cloud", 1, true)),
      refusals_("'" + node.resolveName("octomap") + "' (octomap_msgs/Octomap)"),
      subscriber_(node.subscribe("octomap", 1, &OctomapBridge::receive, this)) {}

void OctomapBridge::receive(const octomap_msgs::Octomap& map) {
  try {
    publisher_.publish(to_cloud(map));
  } catch (const std::invalid_argument& error) {
    refusals_.refuse(error.what());
  }
}

}  // namespace fiber_proximity_ros
