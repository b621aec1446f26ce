#pragma once

#include <dynamic_reconfigure/server.h>
#include <ros/node_handle.h>

#include <string>

#include "fiber_proximity/ProximityConfig.h"
#include "fiber_proximity/query/options.hpp"
#include "src/ros/server/asked_config.hpp"

namespace fiber_proximity_ros {

/// The parameters that can change while the node runs, as they are now. dynamic_reconfigure serves
/// them; bad values are refused, all of a request or nothing, and the log is told why.
class Settings {
 public:
  /// @param config at the start
  Settings(const ros::NodeHandle& private_node, const fiber_proximity::ProximityConfig& config);

  const fiber_proximity::ProximityConfig& config() const { return config_; }

  /// The query that the parameters ask for.
  const fiber::QueryOptions& query() const { return query_; }

 private:
  void change(AskedConfig& asked);

  ros::NodeHandle private_node_;
  AskedConfig config_;
  fiber::QueryOptions query_;
  std::string told_;  // of accuracy_problem()
  dynamic_reconfigure::Server<AskedConfig> server_;
};

}  // namespace fiber_proximity_ros
