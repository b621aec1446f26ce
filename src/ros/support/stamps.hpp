#pragma once

#include <ros/time.h>

namespace fiber_proximity_ros {

/// Whether a stamp is one that a message may have now. The past is unlimited, as a recording has
/// stamps of the past; one of the future would be that of all answers until then. Before the first
/// /clock nothing is too far ahead.
/// @param max_ahead [s] the parameter max_stamp_ahead
/// @throws std::invalid_argument saying what is wrong with it, and what is allowed
void validate_stamp(const ros::Time& stamp, const ros::Time& now, double max_ahead);

}  // namespace fiber_proximity_ros
