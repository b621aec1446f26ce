#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "fiber_proximity/MeasureSettings.h"
#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/query/options.hpp"
#include "src/ros/inputs/fiber_message.hpp"

namespace fiber_proximity_ros {

/// Serves ~measure_settings: what each setting costs and errs on the fibres that the node has now.
/// It works in a thread of its own, of lower priority and on one core, so that the node's answers
/// are not delayed.
class MeasureService {
 public:
  /// @param engine one of fiber::engine_names(), the node's
  MeasureService(const ros::NodeHandle& private_node, std::string engine);
  ~MeasureService();
  MeasureService(const MeasureService&) = delete;
  MeasureService& operator=(const MeasureService&) = delete;

  /// Lets the service have the fibres that the node has now. Nothing is done unless somebody has
  /// asked for them.
  /// @param asked what the node asks about them
  void offer(const std::shared_ptr<const FiberMessage>& fibers, const fiber::QueryOptions& asked);

 private:
  /// The fibres and settings that a measurement is about.
  struct Material {
    std::vector<std::shared_ptr<const FiberMessage>> frames;
    fiber::QueryOptions asked;
  };

  bool measure(fiber_proximity::MeasureSettings::Request& request,
               fiber_proximity::MeasureSettings::Response& response);

  /// Collects the frames of some time [s], at least one.
  /// @throws std::runtime_error if there are no fibres
  Material collect(double seconds);

  const std::string engine_;
  std::mutex mutex_;
  std::condition_variable has_more_;
  std::atomic<bool> is_collecting_{false};
  std::atomic<bool> is_ending_{false};
  Material material_;  // guarded by mutex_

  // Last, so that they go first: callbacks come from here.
  ros::CallbackQueue queue_;
  ros::ServiceServer server_;
  ros::AsyncSpinner spinner_{1, &queue_};
};

}  // namespace fiber_proximity_ros
