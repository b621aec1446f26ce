#include "src/ros/player/fiber_player.hpp"

#include <ros/ros.h>

#include <exception>

int main(int argc, char** argv) {
  ros::init(argc, argv, "fiber_player");
  // Out here: with the last node handle goes the log, and with it the error below.
  const ros::NodeHandle node;
  try {
    const fiber_proximity_ros::FiberPlayer player(
        node, fiber_proximity_ros::read_player_options(ros::NodeHandle("~")));
    ros::spin();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 2;
  }
  return 0;
}
