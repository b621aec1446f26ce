#pragma once

#include <ros/node_handle.h>

#include <memory>

namespace fiber_proximity_ros {

/// A ProximityServer for those who only hold it: its own header brings all that it is made of,
/// which takes the compiler a quarter of a minute.
/// @throws what its constructor throws
std::shared_ptr<void> make_proximity_server(const ros::NodeHandle& node,
                                            const ros::NodeHandle& private_node);

}  // namespace fiber_proximity_ros
