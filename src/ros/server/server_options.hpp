#pragma once

#include <ros/node_handle.h>

#include <string>

#include "fiber_proximity/ProximityConfig.h"
#include "fiber_proximity/query/engine.hpp"
#include "src/ros/detection/observed_scene.hpp"

namespace fiber_proximity_ros {

/// Parameters of the proximity node at its start; their defaults are in cfg/interface.yaml.
struct ServerOptions {
  std::string engine;  ///< one of fiber::engine_names()
  fiber::EngineOptions engine_options;

  FiberInputOptions fibers;

  double marker_rate{};  ///< [Hz] markers are drawn at most this often

  double heartbeat{};  ///< [s] answers are repeated that often while something is unknown; 0: not

  fiber_proximity::ProximityConfig config;  ///< those that can change later
};

/// Reads the private parameters; those that are absent keep their defaults. A bad entry of `inputs`
/// is logged and left out, so that one typing error does not blind the node to its other cables; so
/// is every parameter nothing knows.
/// @throws std::invalid_argument for any other bad parameter, naming it, its value and what is
///         allowed
ServerOptions read_server_options(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

/// Checks the parameters that can change while the node runs. Their types and ranges are those of
/// cfg/interface.yaml.
/// @throws std::invalid_argument naming the parameter, its value and what is allowed
void check(const ros::NodeHandle& private_node, const fiber_proximity::ProximityConfig& config);

}  // namespace fiber_proximity_ros
