#pragma once

#include <ros/time.h>

#include <map>
#include <optional>
#include <string>

#include "fiber_proximity/sim/scene/scene.hpp"
#include "src/ros/inputs/fixed_frame.hpp"

namespace fiber_proximity_ros {

constexpr double fastest_frame = 5.0;  ///< [m/s] as after a gap they may be far away

/// Moves holds that follow frames of tf. A hold stays where it is while tf does not know its frame,
/// or nothing new of it has come for some time, and goes no further than its fibre reaches
/// (lead()). It warns of both, and logs when the hold follows again.
class SimFrames {
 public:
  /// @param world   in which the fibres are; must outlive this
  /// @param timeout [s] of wall time without anything new of a frame
  SimFrames(const FixedFrame& world, double timeout) : world_(world), timeout_(timeout) {}

  /// Waits until tf knows all frames of a scene that has just been made, and brings the obstacles
  /// that follow some to them.
  /// @param timeout [s] of wall time
  /// @throws std::invalid_argument naming the scene's line, fibre or obstacle, and the frame: if it
  ///         does not come, or fibres are where it has the obstacle
  void wait_for(const fiber::SimDescription& description, const fiber::SimScene& scene,
                double timeout) const;

  /// Leads all holds and obstacles to their frames during the next frame of the scene, no faster
  /// than 5 m/s, as after a gap they may be far away.
  void follow(const fiber::SimScene& scene);

 private:
  struct Watch {
    ros::Time stamp;        // of the latest transform
    ros::SteadyTime since;  // when it came; when it was first asked for while there is none
    bool is_frozen = false;
    bool is_held_back = false;  // out of reach, or nowhere
  };

  /// @param problem why nothing new is known; empty if there is something new
  template <class Followed>
  void watch(const Followed& followed, Watch& watch, const std::string& problem) const;

  /// The latest pose of what is followed; none while tf does not know it, which it warns of.
  template <class Followed>
  std::optional<FramePose> look(const Followed& followed);
  void follow_obstacles(const fiber::SimScene& scene);

  const FixedFrame& world_;
  double timeout_;
  std::map<std::string, Watch> watches_;  // by what is held
};

}  // namespace fiber_proximity_ros
