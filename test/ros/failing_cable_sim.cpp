// cable_sim, of whose scene what moves last goes to where there is nothing: a frame fails. Files of
// scenes cannot say that.
#include <ros/init.h>

#include <exception>
#include <iostream>
#include <limits>

#include "src/ros/sim/sim_server.hpp"

int main(int argc, char** argv) {
  try {
    ros::init(argc, argv, "cable_sim");
    const ros::NodeHandle node;
    const ros::NodeHandle private_node("~");
    const auto options = fiber_proximity_ros::read_sim_options(node, private_node);
    fiber::SimDescription description = fiber_proximity_ros::read_scene(options);
    for (fiber::SimHold& hold : description.holds) {
      hold.path.back().position.x() = std::numeric_limits<double>::infinity();
    }
    const fiber_proximity_ros::SimServer server(node, private_node, options, description);
    ros::spin();
  } catch (const std::exception& error) {
    std::cerr << "failing_cable_sim: " << error.what() << '\n';
    return 2;
  }
  return 0;
}
