#include "src/ros/environment/scene_obstacles.hpp"

#include <ros/console.h>

#include <exception>
#include <utility>

namespace fiber_proximity_ros {

SceneObstacles::SceneObstacles(const std::vector<fiber::SceneObstacle>& obstacles) {
  for (const fiber::SceneObstacle& obstacle : obstacles) {
    FramedChange change;
    change.header.frame_id = obstacle.frame_id;
    change.change.object = obstacle.object;
    waiting_.push_back({change, "not looked for yet"});
  }
}

bool SceneObstacles::update(ObstacleSet& obstacles, FixedFrame& frame) {
  const std::size_t before = waiting_.size();
  std::vector<Waiting> waiting;
  for (Waiting& obstacle : waiting_) {
    const std::string& name = obstacle.change.change.object.name;
    if (obstacles.has(name)) {
      ROS_WARN_STREAM("obstacle '" << name << "' of the scene is left out: another of this name "
                                   << "was added before its transform was known");
      continue;
    }
    try {
      const Eigen::Isometry3d pose = locate(framed_name(obstacle.change), frame);
      obstacles.apply({placed(obstacle.change, pose)});
    } catch (const std::exception& error) {  // above all TransformUnavailable
      obstacle.error = error.what();
      waiting.push_back(std::move(obstacle));
    }
  }
  waiting_ = std::move(waiting);
  return waiting_.size() != before;
}

std::vector<std::string> SceneObstacles::unknown() const {
  std::vector<std::string> unknown;
  for (const Waiting& obstacle : waiting_) {
    unknown.push_back(obstacle.error);
  }
  return unknown;
}

}  // namespace fiber_proximity_ros
