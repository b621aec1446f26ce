#pragma once

#include <ros/time.h>

#include <map>
#include <string>
#include <vector>

#include "fiber_proximity/sim/scene/scene.hpp"
#include "src/ros/inputs/fixed_frame.hpp"

namespace fiber_proximity_ros {

/// Keeps what frames of tf hold where these are. What a frame holds that tf does not know, or of
/// which nothing new has come for some time, stays where it is, and what its fibre does not reach
/// goes no further (lead()), with a warning; and with a word when it follows again.
class SimFrames {
 public:
  /// @param world   in which the fibres are; must outlive this
  /// @param timeout [s] of wall time without anything new of a frame
  SimFrames(const FixedFrame& world, double timeout) : world_(world), timeout_(timeout) {}

  /// Waits until tf knows all these frames.
  /// @param timeout [s] of wall time
  /// @throws std::invalid_argument naming the scene's line, the fibre and the frame that did not
  /// come
  void wait_for(const std::vector<fiber::FollowedFrame>& frames, double timeout) const;

  /// Leads all that is held from where it is to where the frames are, during the next frame of the
  /// scene; no faster than 5 m/s, as after a gap it may be far away.
  void follow(const fiber::SimScene& scene);

 private:
  struct Watch {
    ros::Time stamp;        // of the latest transform
    ros::SteadyTime since;  // when it came; when it was first asked for while there is none
    bool is_frozen = false;
    bool is_held_back = false;  // out of reach, or nowhere
  };

  /// @param problem why nothing new is known; empty if there is something new
  void watch(const fiber::FollowedFrame& followed, Watch& watch, const std::string& problem) const;

  const FixedFrame& world_;
  double timeout_;
  std::map<std::string, Watch> watches_;  // by what is held
};

}  // namespace fiber_proximity_ros
