#pragma once

#include <interactive_markers/interactive_marker_server.h>

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "src/ros/inputs/fixed_frame.hpp"
#include "src/sim/scene/reach.hpp"

namespace fiber_proximity_ros {

/// Handles for rviz on both ends of fibres, FIBRE/first and FIBRE/last: a user grabs an end, drags
/// it, and lets go. What a scene's hold held before stays where it is left; what nothing held is
/// free again.
class SimMarkers {
 public:
  /// @param topic of which the server's topics are parts
  /// @param world the frame of the scene; must outlive this
  SimMarkers(const std::string& topic, const FixedFrame& world);

  /// Makes handles for a scene, which must have the effect attachment, in place of those before:
  /// for its first fibres if it has very many.
  void begin(const fiber::SimScene& scene);

  /// Takes over what users have done since the last frame; dragged ends move towards where they are
  /// wanted in the next frame, no faster than a hand.
  void apply(fiber::SimScene& scene);

  /// Brings the handles to where the ends are.
  void update(const fiber::SimScene& scene);

 private:
  struct Grab {
    std::shared_ptr<fiber::PlacementPath> path;  // from one frame to the next
    Eigen::Vector3d target;
    bool was_held = false;
    bool is_over = false;
  };

  void receive(const visualization_msgs::InteractiveMarkerFeedback& feedback);

  const FixedFrame& world_;
  std::map<std::string, fiber::NodeOfRod> ends_;
  std::map<std::string, Grab> grabs_;

  // The server's callbacks may run in another thread than all else, in a nodelet.
  std::mutex mutex_;
  std::vector<visualization_msgs::InteractiveMarkerFeedback> received_;

  interactive_markers::InteractiveMarkerServer server_;  // last: its callbacks use the above
};

}  // namespace fiber_proximity_ros
