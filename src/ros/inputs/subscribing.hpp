#pragma once

#include <ros/console.h>
#include <ros/exceptions.h>

#include <string>

namespace fiber_proximity_ros {

/// Calls a function that subscribes to a topic that somebody has configured. A topic has one type
/// in a process: where another part of it, or another nodelet, has subscribed with another type,
/// this one is left out, and the log says so.
/// @param where what the log calls what is left out
/// @returns false if it is left out
template <class Subscribe>
bool subscribes(const std::string& where, const Subscribe& subscribe) {
  try {
    subscribe();
    return true;
  } catch (const ros::ConflictingSubscriptionException& error) {
    ROS_ERROR_STREAM(where << " is left out: its topic is subscribed to with another type already: "
                           << error.what());
    return false;
  }
}

}  // namespace fiber_proximity_ros
