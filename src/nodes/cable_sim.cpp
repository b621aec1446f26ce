#include <ros/init.h>

#include <exception>
#include <iostream>

#include "src/ros/sim/sim_server.hpp"

int main(int argc, char** argv) {
  try {
    ros::init(argc, argv, "cable_sim");
    const ros::NodeHandle node;
    const ros::NodeHandle private_node("~");
    const fiber_proximity_ros::SimServer server(
        node, private_node, fiber_proximity_ros::read_sim_options(node, private_node));
    ros::spin();
  } catch (const std::exception& error) {
    std::cerr << "cable_sim: " << error.what() << '\n';
    return 2;
  }
  return 0;
}
