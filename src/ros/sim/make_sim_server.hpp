#pragma once

#include <ros/node_handle.h>

#include <memory>

namespace fiber_proximity_ros {

/// A SimServer with the options of its parameters, for those who only hold it, as
/// make_proximity_server() has it.
/// @throws what read_sim_options() and its constructor throw
std::shared_ptr<void> make_sim_server(const ros::NodeHandle& node,
                                      const ros::NodeHandle& private_node);

}  // namespace fiber_proximity_ros
