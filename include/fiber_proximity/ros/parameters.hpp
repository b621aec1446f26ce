#pragma once

#include <ros/node_handle.h>

#include <cstdint>
#include <string>

namespace fiber_proximity_ros {

/// @throws std::invalid_argument naming the parameter, its value and what is allowed
[[noreturn]] void refuse_parameter(const ros::NodeHandle& node, const std::string& name,
                                   const std::string& allowed);

/// Reads a parameter; one that is not set leaves the value as it is.
/// @throws std::invalid_argument if it is of another type: roscpp alone would keep silent
template <class Value>
void read_parameter(const ros::NodeHandle& node, const std::string& name,
                    const std::string& allowed, Value& value) {
  if (node.hasParam(name) && !node.getParam(name, value)) {
    refuse_parameter(node, name, allowed);
  }
}

/// Reads a finite number of at least this limit.
/// @throws std::invalid_argument if it is anything else
void read_parameter(const ros::NodeHandle& node, const std::string& name, double least,
                    double& value);

/// Reads a whole number of at least 0.
/// @throws std::invalid_argument if it is anything else
void read_parameter(const ros::NodeHandle& node, const std::string& name, std::uint32_t& value);

}  // namespace fiber_proximity_ros
