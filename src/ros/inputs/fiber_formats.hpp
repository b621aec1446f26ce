#pragma once

#include <ros/node_handle.h>
#include <std_msgs/Header.h>

#include <functional>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber_proximity_ros {

/// A message that fibres can travel in, as different trackers send them.
struct FiberFormat {
  std::string name;
  bool one_fiber = false;  ///< the message has room for a single one

  using Publish = std::function<void(const std_msgs::Header&, const fiber::FiberAssembly&)>;
  /// Advertises the topic; what it returns publishes fibres there.
  std::function<Publish(ros::NodeHandle& node, const std::string& topic)> advertise;
};

/// `fiber_array`, `marker_array` and, for one fibre, `marker`, `point_cloud2`, `point_cloud`,
/// `pose_array` and `path`. Only `fiber_array` tells the radius; a marker's width is the diameter
/// of the fibre's first segment.
const std::vector<FiberFormat>& fiber_formats();

/// @throws std::invalid_argument listing the names
const FiberFormat& find_fiber_format(const std::string& name);

}  // namespace fiber_proximity_ros
