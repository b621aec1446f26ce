#pragma once

#include <ros/node_handle.h>

#include <set>
#include <string>

#include "fiber_proximity/ProximityConfig.h"

namespace fiber_proximity_ros {

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
  void __fromServer__(const ros::NodeHandle& private_node);
  // NOLINTEND(bugprone-reserved-identifier, cert-dcl37-c, cert-dcl51-cpp)

  /// Why the message that was read last has something that is no parameter of its name and type;
  /// empty if all are.
  const std::string& problem() const { return problem_; }

  /// Whether somebody has set this parameter, perhaps to its default, in a request that was not
  /// about all parameters: those have every one.
  bool has_named(const std::string& name) const { return named_.count(name) > 0; }

 private:
  void add_names(std::set<std::string> names);

  std::string problem_;
  std::set<std::string> named_;
};

}  // namespace fiber_proximity_ros
