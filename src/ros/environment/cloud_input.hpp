#pragma once

#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <sensor_msgs/PointCloud2.h>

#include <functional>
#include <optional>
#include <string>

#include "fiber_proximity/InputStatistics.h"
#include "fiber_proximity/environment/world.hpp"
#include "src/ros/environment/cloud_worker.hpp"
#include "src/ros/inputs/fixed_frame.hpp"
#include "src/ros/inputs/refusal_log.hpp"

namespace fiber_proximity_ros {

/// The point cloud of the topic ~cloud as an object of the world.
///
/// At most two clouds wait for their transforms: one that keeps its turn until its transform
/// arrives or the timeout is over, and the newest one behind it.
class CloudInput {
 public:
  /// @param tf_timeout [s] of wall time a cloud may wait for its transform
  /// @param on_message called for each cloud that arrives
  CloudInput(ros::NodeHandle private_node, const CloudOptions& options, double tf_timeout,
             std::function<void()> on_message);

  /// Has clouds made into octrees whose transforms are known, puts the newest finished one into the
  /// world, and removes it when all its cells have decayed.
  /// @returns true if the world changed
  bool update(const ros::Time& now, FixedFrame& frame, fiber::World& world);

  /// True if update() should be called again soon.
  bool is_waiting() const { return waiting_ || worker_.is_busy(); }

  fiber_proximity::InputStatistics statistics(const ros::Time& now) const;

  /// What became of the points of the newest cloud, and how long that took.
  const CloudResult& newest() const { return newest_; }

 private:
  struct Cloud {
    sensor_msgs::PointCloud2::ConstPtr message;
    ros::SteadyTime arrival;
  };

  void receive(const sensor_msgs::PointCloud2::ConstPtr& message);

  /// @returns false if the waiting cloud goes on waiting
  bool place_waiting(FixedFrame& frame);
  bool put_into_world(CloudResult result, fiber::World& world);
  void warn_if_unused() const;
  bool remove_decayed(const ros::Time& now, fiber::World& world);

  double resolution_;
  double decay_;
  double tf_timeout_;
  std::function<void()> on_message_;
  RefusalLog refusals_;
  std::uint64_t received_ = 0;
  std::uint64_t overtaken_ = 0;
  std::optional<Cloud> waiting_;
  std::optional<Cloud> next_;
  CloudResult newest_;
  CloudWorker worker_;
  ros::Subscriber subscriber_;  // last: its callback uses all of the above
};

}  // namespace fiber_proximity_ros
