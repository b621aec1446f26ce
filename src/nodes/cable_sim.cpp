#include <ros/init.h>

#include <exception>
#include <iostream>

#include "src/ros/sim/make_sim_server.hpp"

int main(int argc, char** argv) {
  try {
    ros::init(argc, argv, "cable_sim");
    const ros::NodeHandle node;
    const ros::NodeHandle private_node("~");
    const auto server = fiber_proximity_ros::make_sim_server(node, private_node);
    ros::spin();
  } catch (const std::exception& error) {
    std::cerr << "cable_sim: " << error.what() << '\n';
    return 2;
  }
  return 0;
}
