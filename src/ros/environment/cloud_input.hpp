#pragma once

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <sensor_msgs/PointCloud2.h>

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/InputStatistics.h"
#include "fiber_proximity/environment/world.hpp"
#include "src/ros/environment/cloud_cells.hpp"
#include "src/ros/inputs/fixed_frame.hpp"
#include "src/ros/inputs/message_log.hpp"
#include "src/ros/support/unknown.hpp"
#include "src/ros/support/worker.hpp"

namespace fiber_proximity_ros {

/// The point cloud of the topic ~cloud as an object of the world. Its octree is made in a thread of
/// its own, so that fibres need not wait for it.
///
/// At most two clouds wait for their transforms: one that keeps its turn until its transform
/// arrives or the timeout is over, and the newest one behind it.
class CloudInput {
 public:
  /// @param tf_timeout      [s] of wall time a cloud may wait for its transform
  /// @param max_stamp_ahead [s] a stamp may be ahead of the node's time
  /// @param on_message called for each cloud that arrives
  /// @throws std::invalid_argument as CloudCells
  CloudInput(ros::NodeHandle private_node, const CloudOptions& options, double tf_timeout,
             double max_stamp_ahead, std::function<void()> on_message);

  /// Has clouds made into octrees whose transforms are known, puts the newest finished one into the
  /// world, and removes it when all its cells have decayed.
  /// @returns true if the world changed
  bool update(const ros::Time& now, FixedFrame& frame, fiber::World& world);

  /// Forgets all clouds, as time has gone back.
  /// @returns true if the world changed
  bool reset(const ros::Time& now, fiber::World& world);

  /// True if update() should be called again soon.
  bool is_waiting() const { return waiting_ || in_work_; }

  /// Tells why the cloud is not known: no cloud has come yet, none with a new stamp has for the
  /// timeout though its publisher does not keep its last one for others (a latched topic), all of
  /// it has decayed, or points were beyond the octree.
  std::optional<Unknown> unknown(const ros::Time& now) const;

  /// Counts of messages, and of the points of the newest cloud.
  fiber_proximity::InputStatistics statistics(const ros::Time& now) const;

 private:
  struct Cloud {
    sensor_msgs::PointCloud2::ConstPtr message;
    bool is_latched;
    ros::SteadyTime arrival;
  };

  /// The octree of a cloud, and how it came about.
  struct Result {
    std::shared_ptr<const fiber::OccupancyOctree> octree;  // null if no cell is occupied
    CloudCounts counts;
    ros::Time stamp;
    bool is_latched = false;
  };
  using MakeResult = std::function<Result()>;

  void receive(const ros::MessageEvent<const sensor_msgs::PointCloud2>& event);

  /// @returns false if the waiting cloud goes on waiting
  bool place_waiting(FixedFrame& frame);
  Result use(const Cloud& cloud, const Eigen::Isometry3d& pose, const ros::Time& stamp);
  bool take_result(fiber::World& world);
  void warn_if_unused() const;
  bool has_decayed(const ros::Time& now) const;
  bool remove_decayed(const ros::Time& now, fiber::World& world);

  double resolution_;
  double decay_;
  double timeout_;
  bool required_;
  double tf_timeout_;
  double max_stamp_ahead_;
  std::function<void()> on_message_;
  MessageLog log_;
  std::optional<Cloud> waiting_;
  std::optional<Cloud> next_;
  std::optional<MakeResult> placed_;  // what is to become of the newest that has its transform
  std::optional<Prepared<Result>> in_work_;
  Result newest_;
  ros::Time last_use_ = ros::Time::now();  // or when it was first waited for
  CloudCells cells_;                       // the worker's alone

  // Last: its job and its callback use all of the above.
  Worker worker_;
  ros::Subscriber subscriber_;
};

}  // namespace fiber_proximity_ros
