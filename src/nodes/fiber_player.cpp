#include "fiber_proximity/ros/fiber_player.hpp"

#include <ros/init.h>

#include <exception>
#include <iostream>

int main(int argc, char** argv) {
  try {
    ros::init(argc, argv, "fiber_player");
    const fiber_proximity_ros::FiberPlayer player(
        ros::NodeHandle(), fiber_proximity_ros::read_player_options(ros::NodeHandle("~")));
    ros::spin();
  } catch (const std::exception& error) {
    std::cerr << "fiber_player: " << error.what() << '\n';
    return 2;
  }
  return 0;
}
