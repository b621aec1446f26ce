#include <ros/init.h>

#include "src/ros/bridges/octomap_bridge.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "octomap_bridge");
  const fiber_proximity_ros::OctomapBridge bridge{ros::NodeHandle()};
  ros::spin();
  return 0;
}
