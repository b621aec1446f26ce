#pragma once

#include <ros/time.h>

#include <chrono>

namespace fiber_proximity_ros {

/// A stamp as time since the epoch.
std::chrono::nanoseconds to_time(const ros::Time& stamp);

/// The stamp of a time since the epoch; times before it become the epoch itself, those after the
/// last that a stamp may have that one.
ros::Time to_stamp(std::chrono::nanoseconds time);

/// Whether a stamp is one that a message may have now. The past is unlimited, as a recording has
/// stamps of the past; one of the future would be that of all answers until then. Before the first
/// /clock nothing is too far ahead.
/// @param max_ahead [s] the parameter max_stamp_ahead
/// @throws std::invalid_argument saying what is wrong with it, and what is allowed
void validate_stamp(const ros::Time& stamp, const ros::Time& now, double max_ahead);

}  // namespace fiber_proximity_ros
