#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <std_msgs/Header.h>

#include <functional>

#include "fiber_proximity/Predict.h"
#include "fiber_proximity/sim/scene/scene.hpp"

namespace fiber_proximity_ros {

/// A scene as it runs, to look ahead in.
struct SceneCopy {
  fiber::SimScene scene;
  std_msgs::Header header;  ///< of its fibres now
};

/// Serves ~predict. Up to four predictions are made at once, in threads of their own that give way
/// to the running scene.
class PredictService {
 public:
  /// @param copy      of the running scene, called by any thread
  /// @param is_ending whether the node ends
  PredictService(ros::NodeHandle private_node, std::function<SceneCopy()> copy,
                 std::function<bool()> is_ending);

 private:
  bool predict(fiber_proximity::Predict::Request& request,
               fiber_proximity::Predict::Response& response);

  std::function<SceneCopy()> copy_;
  std::function<bool()> is_ending_;
  ros::CallbackQueue queue_;
  ros::ServiceServer server_;
  ros::AsyncSpinner spinner_;
};

}  // namespace fiber_proximity_ros
