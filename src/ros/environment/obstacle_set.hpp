#pragma once

#include <ros/time.h>

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/Obstacle.h"
#include "fiber_proximity/environment/scene/environment_scene.hpp"
#include "fiber_proximity/environment/world.hpp"
#include "src/ros/environment/object_tracks.hpp"
#include "src/ros/environment/waiting_changes.hpp"
#include "src/ros/support/unknown.hpp"
#include "src/ros/support/worker.hpp"

namespace fiber_proximity_ros {

/// Who takes part in changes of obstacles.
struct ChangeHooks {
  /// Called before they are made: std::invalid_argument that it throws refuses all of them.
  std::function<void(const std::vector<fiber::ObjectChange>& changes)> check;

  /// Called with each that has been made, and when the object was there.
  std::function<void(const fiber::ObjectChange& change, const ros::Time& stamp)> take;
};

/// The objects of the world that came as obstacles, and so not those of robot and cloud.
class ObstacleSet {
 public:
  /// @param world must outlive this
  ObstacleSet(fiber::World& world, ChangeHooks hooks) : world_(world), hooks_(std::move(hooks)) {}

  /// @param tracks takes the changes; must outlive this, as the world
  ObstacleSet(fiber::World& world, ObjectTracks& tracks)
      : ObstacleSet(world, {[](const auto& /*changes*/) {},
                            [&tracks](const fiber::ObjectChange& change, const ros::Time& stamp) {
                              tracks.take(change, stamp);
                            }}) {}

  /// Applies the changes, which are in the fixed frame, or none. A REMOVE of an empty name is that
  /// of all obstacles.
  /// @param stamps    when objects were there, by change; zero: now
  /// @param cancelled names that a REMOVE may have even if there is no such obstacle
  /// @param owner     a topic that adds obstacles of its own; empty: the scene, ~obstacles and
  ///                  ~apply_obstacles, which share theirs
  /// @throws std::invalid_argument as fiber::World::apply, for what is checked, and where an
  ///         obstacle would take the place of another owner's
  void apply(const std::vector<fiber::ObjectChange>& changes, const std::vector<ros::Time>& stamps,
             const std::set<std::string>& cancelled = {}, const std::string& owner = "");

  /// Makes a change of these obstacles; large meshes are built by the worker.
  /// @param patience see Change
  Change change_of(std::shared_ptr<const std::vector<fiber_proximity::Obstacle>> obstacles,
                   double patience, Worker& worker);

  bool has(const std::string& name) const { return owners_.count(name) != 0; }

  /// Whether there is an obstacle of a name that the owner has added.
  bool has(const std::string& name, const std::string& owner) const {
    const auto found = owners_.find(name);
    return found != owners_.end() && found->second == owner;
  }

 private:
  fiber::World& world_;
  ChangeHooks hooks_;
  std::map<std::string, std::string> owners_;  // by the obstacle's name
};

/// Obstacles of the scene, each of which is unknown until tf knows its frame, however long that
/// takes.
class SceneObstacles {
 public:
  explicit SceneObstacles(const std::vector<fiber::SceneObstacle>& obstacles);

  /// Adds those whose frames are known by now; one whose name is taken by now is left out, with a
  /// warning.
  /// @returns true if there are any
  bool update(ObstacleSet& obstacles, FixedFrame& frame);

  /// Lists the obstacles that are not in the world yet.
  std::vector<Unknown> unknown() const;

 private:
  struct Waiting {
    fiber::SceneObstacle obstacle;
    std::string error;
  };

  std::vector<Waiting> waiting_;
  ros::Time beginning_ = ros::Time::now();
};

}  // namespace fiber_proximity_ros
