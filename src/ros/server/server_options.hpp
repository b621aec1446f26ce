#pragma once

#include <ros/node_handle.h>

#include <string>
#include <vector>

#include "fiber_proximity/ProximityConfig.h"
#include "fiber_proximity/query/engine.hpp"
#include "src/ros/inputs/input.hpp"
#include "src/ros/inputs/input_source.hpp"

namespace fiber_proximity_ros {

/// Parameters of the proximity node at its start.
struct ServerOptions {
  std::string engine = "run_tree";  ///< one of fiber::engine_names()
  fiber::EngineOptions engine_options;

  /// All results are in this frame; empty: the frame of the first message.
  std::string fixed_frame;

  InputTiming timing;

  double marker_rate = 15.0;  ///< [Hz] markers are drawn at most this often

  std::vector<InputOptions> inputs;

  fiber_proximity::ProximityConfig config;  ///< those that can change later
};

/// Reads the private parameters; those that are absent keep their defaults. A bad entry of `inputs`
/// is logged and left out, so that one typing error does not blind the node to its other cables; so
/// is every parameter nothing knows.
/// @throws std::invalid_argument for any other bad parameter, naming it, its value and what is
///         allowed
ServerOptions read_server_options(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

/// Names of all private parameters that the node reads.
std::vector<std::string> known_parameters();

}  // namespace fiber_proximity_ros
