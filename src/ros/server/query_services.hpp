#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <vector>

#include "src/ros/detection/detector.hpp"
#include "src/ros/detection/knowledge.hpp"
#include "src/ros/environment/environment_inputs.hpp"
#include "src/ros/inputs/input_set.hpp"

namespace fiber_proximity_ros {

/// What services are asked about, which must outlive them.
struct QuerySubject {
  InputSet& fibers;
  Detector& detector;  ///< knows the fibres of the inputs
  const EnvironmentInputs& environment;
  const Knowledge& knowledge;
  const fiber::QueryOptions& defaults;
};

/// Serves ~query and ~check_fibers, as long as what it returns lives. What asks about the
/// environment alone is answered without any fibres, too.
/// @param before_answer called before a request is answered, to take in what has arrived
std::vector<ros::ServiceServer> serve_queries(ros::NodeHandle private_node,
                                              const QuerySubject& subject,
                                              const std::function<void()>& before_answer);

}  // namespace fiber_proximity_ros
