#include <ros/ros.h>

#include <exception>

#include "src/ros/server/make_proximity_server.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "proximity");
  // Out here: with the last node handle goes the log, and with it the error below.
  const ros::NodeHandle node;
  try {
    const auto server = fiber_proximity_ros::make_proximity_server(node, ros::NodeHandle("~"));
    ros::spin();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 2;
  }
  return 0;
}
