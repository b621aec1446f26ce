#pragma once

#include <ros/node_handle.h>
#include <ros/time.h>

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "fiber_proximity/ObstacleArray.h"
#include "fiber_proximity/environment/world.hpp"
#include "fiber_proximity/sim/scene/scene.hpp"
#include "src/ros/environment/obstacle_set.hpp"
#include "src/ros/environment/waiting_changes.hpp"
#include "src/ros/inputs/fixed_frame.hpp"
#include "src/ros/support/worker.hpp"

namespace fiber_proximity_ros {

/// Obstacles that come, move and go while a simulation runs: subscribes to `obstacles`, whose
/// messages change them as those of the proximity node's ~obstacles do, wholly or not at all. What
/// is refused is warned of, by the name of the obstacle:
///
/// - what would appear where a fibre is, as no side is the right one for that;
/// - what the scene itself has, which moves as the scene tells.
///
/// One that is moved takes the time between the stamps of the two poses for it, as its velocity is
/// to be that, but no less than a frame and no more than a second, and no point of its way is
/// faster than frames of tf may be. An ADD of one that is there already with the same shapes moves
/// it, too.
class SimObstacles {
 public:
  /// @param frame    of the scene; must outlive this
  /// @param patience [s] of wall time that a transform may take to come
  SimObstacles(ros::NodeHandle node, FixedFrame& frame, double patience);

  /// Makes the changes that have come, between two frames of a scene.
  void apply(const fiber::SimDescription& description, fiber::SimScene& scene);

  /// Adds the obstacles there are to a scene that begins. Those that have no room in it are gone.
  void begin(const fiber::SimDescription& description, fiber::SimScene& scene);

 private:
  void receive(const fiber_proximity::ObstacleArray::ConstPtr& message);
  void check(const std::vector<fiber::ObjectChange>& changes) const;
  void take(const fiber::ObjectChange& change, const ros::Time& stamp);
  void move(const fiber::AddedObstacle& added, const Eigen::Isometry3d& pose,
            const ros::Time& stamp);

  std::string topic_;
  double patience_;
  fiber::World world_;  // the obstacles, where they were told to be
  ObstacleSet obstacles_;
  WaitingChanges changes_;
  std::map<std::string, ros::Time> stamps_;  // of their last poses

  // While changes are made.
  const fiber::SimDescription* description_ = nullptr;
  fiber::SimScene* scene_ = nullptr;

  std::mutex mutex_;  // of what has been received, which any thread may do
  std::vector<fiber_proximity::ObstacleArray::ConstPtr> received_;

  // Last: their threads and callbacks use the above.
  Worker mesh_builder_;
  ros::Subscriber subscriber_;
};

}  // namespace fiber_proximity_ros
