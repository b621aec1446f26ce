#pragma once

#include <string>
#include <vector>

#include "src/environment/scene/environment_scene.hpp"
#include "src/ros/environment/obstacle_set.hpp"

namespace fiber_proximity_ros {

/// Obstacles of the scene, each of which is unknown until tf knows its frame, however long that
/// takes.
class SceneObstacles {
 public:
  explicit SceneObstacles(const std::vector<fiber::SceneObstacle>& obstacles);

  /// Adds those whose frames are known by now; one whose name is taken by now is left out, with a
  /// warning.
  /// @returns true if there are any
  bool update(ObstacleSet& obstacles, FixedFrame& frame);

  /// Names of those that are not in the world yet, and why.
  std::vector<std::string> unknown() const;

 private:
  struct Waiting {
    FramedChange change;
    std::string error;
  };

  std::vector<Waiting> waiting_;
};

}  // namespace fiber_proximity_ros
