#include "src/ros/environment/cloud_input.hpp"

#include <ros/console.h>

#include <stdexcept>
#include <utility>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/environment/obstacle_parts.hpp"
#include "src/ros/environment/obstacle_change.hpp"
#include "src/ros/inputs/point_messages.hpp"

namespace fiber_proximity_ros {
namespace {

/// [s] How often a cloud of which nothing is used is logged.
constexpr double unused_warning_period = 5.0;

bool remove_cloud(fiber::World& world) {
  if (!world.has(fiber::cloud_name)) {
    return false;
  }
  world.apply({removal_of(fiber::cloud_name)});
  return true;
}

}  // namespace

CloudInput::CloudInput(ros::NodeHandle private_node, const CloudOptions& options, double tf_timeout,
                       std::function<void()> on_message)
    : resolution_(options.resolution),
      decay_(options.decay),
      tf_timeout_(tf_timeout),
      on_message_(std::move(on_message)),
      log_("cloud", "sensor_msgs/PointCloud2"),
      cells_(options),
      subscriber_(private_node.subscribe("cloud", 1, &CloudInput::receive, this)) {}

bool CloudInput::update(const ros::Time& now, FixedFrame& frame, fiber::World& world) {
  while (waiting_ && place_waiting(frame)) {
    waiting_ = std::exchange(next_, std::nullopt);
  }
  const bool changed = in_work_ && in_work_->is_ready() && take_result(world);
  if (placed_ && !in_work_) {
    in_work_.emplace(*std::exchange(placed_, std::nullopt), &worker_);
  }
  return remove_decayed(now, world) || changed;
}

fiber_proximity::InputStatistics CloudInput::statistics(const ros::Time& now) const {
  fiber_proximity::InputStatistics statistics = log_.statistics();
  statistics.age = newest_.stamp.isZero() ? -1.0 : (now - newest_.stamp).toSec();
  statistics.points_received = newest_.counts.points;
  statistics.points_used = newest_.counts.used();
  statistics.points_not_finite = newest_.counts.not_finite;
  statistics.points_outside_box = newest_.counts.outside_box;
  statistics.points_too_far = newest_.counts.too_far;
  return statistics;
}

void CloudInput::receive(const sensor_msgs::PointCloud2::ConstPtr& message) {
  log_.receive();
  if (next_) {
    log_.overtake();
  }
  (waiting_ ? next_ : waiting_) = Cloud{message, ros::SteadyTime::now()};
  on_message_();
}

bool CloudInput::place_waiting(FixedFrame& frame) {
  std_msgs::Header header = waiting_->message->header;
  header.frame_id = tf2_name(header.frame_id);
  if (header.frame_id.empty()) {
    log_.refuse("header.frame_id is empty, it must name the frame of the points");
    return true;
  }
  frame.adopt(header.frame_id);
  try {
    const ros::Time stamp = header.stamp.isZero() ? ros::Time::now() : header.stamp;
    MakeResult make = [this, message = waiting_->message, pose = frame.transform_from(header),
                       stamp] { return use(*message, pose, stamp); };
    if (std::exchange(placed_, std::move(make))) {
      log_.overtake();
    }
    return true;
  } catch (const TransformUnavailable& error) {
    if ((ros::SteadyTime::now() - waiting_->arrival).toSec() <= tf_timeout_) {
      return false;
    }
    log_.refuse(error.what());
    return true;
  }
}

/// What a cloud becomes that was seen from this pose.
CloudInput::Result CloudInput::use(const sensor_msgs::PointCloud2& message,
                                   const Eigen::Isometry3d& pose, const ros::Time& stamp) {
  FiberBuffer chain;
  to_chains(message, chain);
  const CloudCounts counts = cells_.add(chain.points, pose, stamp.toSec());
  return {cells_.octree(), counts, stamp};
}

bool CloudInput::take_result(fiber::World& world) {
  try {
    newest_ = std::exchange(in_work_, std::nullopt)->get();
  } catch (const std::exception& error) {
    log_.refuse(error.what());
    return false;
  }
  warn_if_unused();
  if (newest_.octree == nullptr) {
    return remove_cloud(world);
  }
  fiber::ObjectChange change;
  change.object.name = fiber::cloud_name;
  change.object.shapes.push_back({newest_.octree, Eigen::Isometry3d::Identity()});
  world.apply({change});
  return true;
}

/// A cloud that has points, but none to use, is most likely a mistake.
void CloudInput::warn_if_unused() const {
  const CloudCounts& counts = newest_.counts;
  if (counts.points > 0 && counts.used() == 0) {
    ROS_WARN_STREAM_THROTTLE(unused_warning_period, "'cloud': none of its "
                                                        << counts.points << " point(s) is used: "
                                                        << reasons_of(counts, resolution_));
  }
}

bool CloudInput::remove_decayed(const ros::Time& now, fiber::World& world) {
  return decay_ > 0.0 && !newest_.stamp.isZero() && (now - newest_.stamp).toSec() > decay_ &&
         remove_cloud(world);
}

}  // namespace fiber_proximity_ros
