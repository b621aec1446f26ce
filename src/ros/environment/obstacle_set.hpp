#pragma once

#include <std_msgs/Header.h>

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "fiber_proximity/Obstacle.h"
#include "fiber_proximity/environment/world.hpp"
#include "src/ros/environment/waiting_changes.hpp"
#include "src/ros/support/worker.hpp"

namespace fiber_proximity_ros {

/// A change that is still in the frame of its message.
struct FramedChange {
  std_msgs::Header header;
  fiber::ObjectChange change;
};

/// @throws std::invalid_argument as to_change
std::vector<FramedChange> to_changes(const std::vector<fiber_proximity::Obstacle>& obstacles);

/// What the frame of the change is to be located for.
FramedName framed_name(const FramedChange& framed);

/// The change with its object where it is in the fixed frame.
/// @param pose of the change's frame there
fiber::ObjectChange placed(const FramedChange& framed, const Eigen::Isometry3d& pose);

/// The objects of the world that came as obstacles, and so not those of robot and cloud.
class ObstacleSet {
 public:
  explicit ObstacleSet(fiber::World& world) : world_(world) {}

  /// Applies the changes, which are in the fixed frame, or none. A REMOVE of an empty name is that
  /// of all obstacles.
  /// @param cancelled names that a REMOVE may have even if there is no such obstacle
  /// @throws std::invalid_argument as fiber::World::apply
  void apply(const std::vector<fiber::ObjectChange>& changes,
             const std::set<std::string>& cancelled = {});

  /// What these obstacles ask for; large meshes are built by the worker.
  /// @param patience see Change
  Change change_of(std::shared_ptr<const std::vector<fiber_proximity::Obstacle>> obstacles,
                   double patience, Worker& worker);

  bool has(const std::string& name) const { return names_.count(name) != 0; }

 private:
  fiber::World& world_;
  std::set<std::string> names_;
};

}  // namespace fiber_proximity_ros
