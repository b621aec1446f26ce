#pragma once

#include <ros/time.h>
#include <std_msgs/Header.h>

#include <memory>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber_proximity_ros {

/// The fibres of one message, or those of several merged.
struct FiberMessage {
  std_msgs::Header header;  ///< its stamp may be zero
  ros::Time stamp;          ///< the time of arrival where the header has none
  ros::Time arrival;        ///< in ROS time
  ros::SteadyTime steady_arrival;
  fiber::FiberAssembly fibers;     ///< in header.frame_id until they are placed in the fixed frame
  std::vector<std::string> names;  ///< one per fibre
  std::string missing;             ///< what of its fibres is not known; empty: nothing
};

using FiberMessagePtr = std::shared_ptr<FiberMessage>;

}  // namespace fiber_proximity_ros
