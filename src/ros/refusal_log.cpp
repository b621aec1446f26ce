#include "fiber_proximity/ros/refusal_log.hpp"

#include <ros/console.h>

namespace fiber_proximity_ros {
namespace {

/// [s] At most one refusal per source and interval is logged.
constexpr double log_interval = 1.0;

}  // namespace

void RefusalLog::refuse(const std::string& reason) {
  ++count_;
  last_error_ = reason;
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (!last_log_.isZero() && (now - last_log_).toSec() < log_interval) {
    ++unlogged_;
    return;
  }
  ROS_ERROR_STREAM(source_ << ": message refused: " << reason
                           << (unlogged_ > 0
                                   ? " (and " + std::to_string(unlogged_) + " more refused since)"
                                   : std::string()));
  last_log_ = now;
  unlogged_ = 0;
}

}  // namespace fiber_proximity_ros
