#pragma once

#include <ros/time.h>

#include <cstddef>
#include <string>
#include <unordered_map>

#include "fiber_proximity/environment/world.hpp"
#include "src/geometry/pose_velocity.hpp"

namespace fiber_proximity_ros {

/// Where the objects of the world have been lately, from which their velocities follow. A track
/// begins where an object is added, also in place of another of its name, and goes on as it moves.
class ObjectTracks {
 public:
  /// @param frames poses of each object that are kept; 0: none, as nobody asks
  void keep(std::size_t frames);

  /// Notes a change that the world has made.
  /// @param stamp when the object was there
  void take(const fiber::ObjectChange& change, const ros::Time& stamp);

  /// Notes where tf has an object: a time that is known already tells nothing new, and one that is
  /// before it begins a new track.
  void observe(const std::string& name, const Eigen::Isometry3d& pose, const ros::Time& stamp);

  void forget(const std::string& name) { tracks_.erase(name); }

  /// Null of an object that no pose is kept of.
  const fiber::PoseVelocity* find(const std::string& name) const {
    const auto found = tracks_.find(name);
    return found == tracks_.end() ? nullptr : &found->second;
  }

 private:
  fiber::PoseVelocity& track_of(const std::string& name) {
    return tracks_.try_emplace(name, frames_).first->second;
  }

  std::size_t frames_ = 0;
  std::unordered_map<std::string, fiber::PoseVelocity> tracks_;
};

}  // namespace fiber_proximity_ros
