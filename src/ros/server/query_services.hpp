#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <vector>

#include "src/ros/detection/detected_scene.hpp"

namespace fiber_proximity_ros {

/// Serves ~query and ~check_fibers, as long as what it returns lives. What asks about the
/// environment alone is answered without any fibres, too.
/// @param before_answer called before a request is answered, to take in what has arrived
std::vector<ros::ServiceServer> serve_queries(ros::NodeHandle private_node,
                                              const DetectedScene& subject,
                                              const std::function<void()>& before_answer);

}  // namespace fiber_proximity_ros
