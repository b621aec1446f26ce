#include "src/ros/environment/cloud_input.hpp"

#include <ros/console.h>

#include <utility>

#include "src/environment/obstacle_parts.hpp"

namespace fiber_proximity_ros {
namespace {

const char* const type_name = "sensor_msgs/PointCloud2";

/// [s] How often a cloud of which nothing is used is logged.
constexpr double unused_warning_period = 5.0;

bool remove_cloud(fiber::World& world) {
  if (!world.has(fiber::cloud_name)) {
    return false;
  }
  fiber::ObjectChange change;
  change.operation = fiber::ObjectChange::Operation::REMOVE;
  change.object.name = fiber::cloud_name;
  world.apply({change});
  return true;
}

}  // namespace

CloudInput::CloudInput(ros::NodeHandle private_node, const CloudOptions& options, double tf_timeout,
                       std::function<void()> on_message)
    : resolution_(options.resolution),
      decay_(options.decay),
      tf_timeout_(tf_timeout),
      on_message_(std::move(on_message)),
      refusals_(std::string("'cloud' (") + type_name + ")"),
      worker_(options),
      subscriber_(private_node.subscribe("cloud", 1, &CloudInput::receive, this)) {}

bool CloudInput::update(const ros::Time& now, FixedFrame& frame, fiber::World& world) {
  while (waiting_ && place_waiting(frame)) {
    waiting_ = std::exchange(next_, std::nullopt);
  }
  bool changed = false;
  for (CloudResult& result : worker_.take()) {
    changed = put_into_world(std::move(result), world) || changed;
  }
  return remove_decayed(now, world) || changed;
}

fiber_proximity::InputStatistics CloudInput::statistics(const ros::Time& now) const {
  fiber_proximity::InputStatistics statistics;
  statistics.topic = "cloud";
  statistics.type = type_name;
  statistics.received = received_;
  statistics.refused = refusals_.count();
  statistics.overtaken = overtaken_;
  statistics.dropped = -1;  // not counted
  statistics.age = newest_.stamp.isZero() ? -1.0 : (now - newest_.stamp).toSec();
  statistics.last_error = refusals_.last_error();
  statistics.points_received = newest_.counts.points;
  statistics.points_used = newest_.counts.used();
  statistics.points_not_finite = newest_.counts.not_finite;
  statistics.points_outside_box = newest_.counts.outside_box;
  statistics.points_too_far = newest_.counts.too_far;
  return statistics;
}

void CloudInput::receive(const sensor_msgs::PointCloud2::ConstPtr& message) {
  ++received_;
  const Cloud cloud{message, ros::SteadyTime::now()};
  if (waiting_) {
    overtaken_ += next_ ? 1 : 0;
    next_ = cloud;
  } else {
    waiting_ = cloud;
  }
  on_message_();
}

bool CloudInput::place_waiting(FixedFrame& frame) {
  std_msgs::Header header = waiting_->message->header;
  header.frame_id = tf2_name(header.frame_id);
  if (header.frame_id.empty()) {
    refusals_.refuse("header.frame_id is empty, it must name the frame of the points");
    return true;
  }
  frame.adopt(header.frame_id);
  try {
    const ros::Time stamp = header.stamp.isZero() ? ros::Time::now() : header.stamp;
    const bool overtakes = worker_.submit({waiting_->message, frame.transform_from(header), stamp});
    overtaken_ += overtakes ? 1 : 0;
    return true;
  } catch (const TransformUnavailable& error) {
    if ((ros::SteadyTime::now() - waiting_->arrival).toSec() <= tf_timeout_) {
      return false;
    }
    refusals_.refuse(error.what());
    return true;
  }
}

bool CloudInput::put_into_world(CloudResult result, fiber::World& world) {
  if (!result.error.empty()) {
    refusals_.refuse(result.error);
    return false;
  }
  newest_ = std::move(result);
  warn_if_unused();
  if (newest_.octree == nullptr) {
    return remove_cloud(world);
  }
  fiber::ObjectChange change;
  change.operation = fiber::ObjectChange::Operation::ADD;
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
