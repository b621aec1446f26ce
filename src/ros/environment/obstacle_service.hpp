#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "fiber_proximity/ApplyObstacles.h"

namespace fiber_proximity_ros {

/// Serves ~apply_obstacles. roscpp answers a service when its callback returns, so callbacks come
/// from threads of their own and wait there until the node has made the change: meanwhile the
/// node's thread goes on.
class ObstacleService {
 public:
  using Obstacles = std::shared_ptr<const std::vector<fiber_proximity::Obstacle>>;

  /// To be called at the end, with the reason if the request is refused. Dropped uncalled, it tells
  /// that the node ends.
  using Answer = std::function<void(const std::string& reason)>;

  /// Makes a change; called from the node's queue.
  using Apply = std::function<void(Obstacles obstacles, const Answer& answer)>;

  ObstacleService(const ros::NodeHandle& private_node, Apply apply);

  /// All answers must have been called or dropped.
  ~ObstacleService();
  ObstacleService(const ObstacleService&) = delete;
  ObstacleService& operator=(const ObstacleService&) = delete;

 private:
  bool answer(fiber_proximity::ApplyObstacles::Request& request,
              fiber_proximity::ApplyObstacles::Response& response);

  Apply apply_;
  ros::CallbackQueueInterface& queue_;  // of the node
  ros::CallbackQueue own_queue_;
  std::mutex mutex_;
  bool stops_ = false;
  ros::ServiceServer server_;
  ros::AsyncSpinner spinner_;
};

}  // namespace fiber_proximity_ros
