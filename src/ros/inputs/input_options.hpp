#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <string>

#include "src/ros/inputs/marker_input.hpp"
#include "src/ros/inputs/missing_points.hpp"

namespace fiber_proximity_ros {

/// One source of fibres: an entry of the parameter `~inputs`.
struct InputOptions {
  std::string topic;
  std::string type = "fiber_proximity/FiberArray";  ///< see input_types.hpp

  /// Of the fibre, where the message does not name it; of several: name/0, name/1, ...
  /// Empty: the topic.
  std::string name;

  double radius = 0.005;  ///< [m] where the message has none; 5 mm, a common cable

  MissingPoints missing_points = MissingPoints::REFUSE;

  MarkerInputOptions marker;  ///< used by the marker types

  std::string where;  ///< what the log calls the entry
};

/// Reads one entry of the list; keys that are absent keep their defaults.
/// @throws std::invalid_argument naming key, value and what is allowed
InputOptions read_input_options(const XmlRpc::XmlRpcValue& entry, double default_radius);

}  // namespace fiber_proximity_ros
