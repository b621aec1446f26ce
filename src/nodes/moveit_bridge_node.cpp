#include <ros/init.h>

#include "src/ros/bridges/moveit_bridge.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "moveit_bridge");
  const fiber_proximity_ros::MoveitBridge bridge{ros::NodeHandle()};
  ros::spin();
  return 0;
}
