#pragma once

#include <std_msgs/Header.h>

#include <set>
#include <string>
#include <vector>

#include "fiber_proximity/Obstacle.h"
#include "fiber_proximity/environment/world.hpp"
#include "fiber_proximity/ros/fixed_frame.hpp"

namespace fiber_proximity_ros {

/// A change that is still in the frame of its message.
struct FramedChange {
  std_msgs::Header header;
  fiber::ObjectChange change;
};

/// @throws std::invalid_argument as to_change
std::vector<FramedChange> to_changes(const std::vector<fiber_proximity::Obstacle>& obstacles);

/// The objects of the world that came as obstacles, and so not those of robot and cloud.
class ObstacleSet {
 public:
  ObstacleSet(fiber::World& world, FixedFrame& frame) : world_(world), frame_(frame) {}

  /// Brings the changes into the fixed frame and applies them all, or none. The first frame there
  /// is becomes the fixed frame if there is none yet.
  /// @throws std::invalid_argument as fiber::World::apply
  /// @throws TransformUnavailable naming the obstacle
  void apply(const std::vector<FramedChange>& changes);

  bool has(const std::string& name) const { return names_.count(name) != 0; }

 private:
  fiber::ObjectChange place(const FramedChange& framed);

  fiber::World& world_;
  FixedFrame& frame_;
  std::set<std::string> names_;
};

}  // namespace fiber_proximity_ros
