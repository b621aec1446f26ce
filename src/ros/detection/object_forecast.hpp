#pragma once

#include <ros/time.h>

#include <cstddef>
#include <string>
#include <vector>

#include "fiber_proximity/environment/environment.hpp"
#include "src/ros/environment/object_tracks.hpp"

namespace fiber_proximity_ros {

/// How the objects around the fibres are assumed to move: each keeps the velocity that follows from
/// its last poses, along its origin's way and about its origin.
struct ObjectForecast {
  /// @param stamp   of the answer
  /// @param timeout [s] an object whose newest pose is older than this stands still
  /// @param horizon [s] how far ahead to look
  ObjectForecast(const fiber::Environment& environment, const ObjectTracks& tracks,
                 const ros::Time& stamp, double timeout, double horizon);

  std::vector<fiber::ObjectDisplacement> displacements;  ///< by object, in `time`

  /// [s] How far ahead can be looked: less than the horizon where an object turns too far by then.
  double time;
  std::string limit;  ///< why not further; empty if the whole horizon can be looked at

  /// Objects whose velocities are known, which may be zero.
  std::size_t moving = 0;
  std::size_t frames = 0;   ///< fewest poses of one of these
  double frame_time = 0.0;  ///< [s] shortest time between the first and the last of them

  std::string assumption;  ///< in words: a clause about objects
};

}  // namespace fiber_proximity_ros
