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

/// The configuration as it is asked for: dynamic_reconfigure::Server would bend a value that is out
/// of range to the nearest that is not, and drop one of another type, before the node sees it.
class AskedConfig : public fiber_proximity::ProximityConfig {
 public:
  AskedConfig() : AskedConfig(__getDefault__()) {}
  // The server makes one of the class's limits, too.
  // NOLINTNEXTLINE(google-explicit-constructor, hicpp-explicit-conversions)
  AskedConfig(const fiber_proximity::ProximityConfig& config) : ProximityConfig(config) {}

  // The server calls these; they hide those of the base class.
  // NOLINTBEGIN(bugprone-reserved-identifier, cert-dcl37-c, cert-dcl51-cpp)
  void __clamp__() {}
  bool __fromMessage__(dynamic_reconfigure::Config& message);
  // NOLINTEND(bugprone-reserved-identifier, cert-dcl37-c, cert-dcl51-cpp)

  /// Why the message that was read last has something that is no parameter of its name and type;
  /// empty if all are.
  const std::string& problem() const { return problem_; }

 private:
  std::string problem_;
};

}  // namespace fiber_proximity_ros
