#include "src/ros/inputs/pose_input.hpp"

#include <stdexcept>
#include <string>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/text/quote.hpp"

namespace fiber_proximity_ros {

void to_chains(const geometry_msgs::PoseArray& message, FiberBuffer& chains) {
  chains.clear();
  chains.header = message.header;
  chains.points.reserve(message.poses.size());
  for (const geometry_msgs::Pose& pose : message.poses) {
    chains.points.push_back(to_vector(pose.position));
  }
  chains.end_chain();
}

void to_chains(const nav_msgs::Path& message, FiberBuffer& chains) {
  chains.clear();
  chains.header = message.header;
  chains.points.reserve(message.poses.size());
  for (const geometry_msgs::PoseStamped& pose : message.poses) {
    // Many publishers fill in the path's frame only.
    if (!pose.header.frame_id.empty() && pose.header.frame_id != message.header.frame_id) {
      throw std::invalid_argument("pose " + std::to_string(chains.points.size()) + " is in frame " +
                                  fiber::quote(pose.header.frame_id) + ", the path in " +
                                  fiber::quote(message.header.frame_id) +
                                  "; they must be the same");
    }
    chains.points.push_back(to_vector(pose.pose.position));
  }
  chains.end_chain();
}

}  // namespace fiber_proximity_ros
