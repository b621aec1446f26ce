#include "src/ros/environment/cloud_input.hpp"

#include <ros/console.h>

#include <sstream>
#include <stdexcept>
#include <utility>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/environment/obstacle_parts.hpp"
#include "src/ros/environment/obstacle_change.hpp"
#include "src/ros/inputs/point_messages.hpp"
#include "src/ros/support/stamps.hpp"

namespace fiber_proximity_ros {
namespace {

/// [s] The time between two warnings of clouds without a point that is used.
constexpr double unused_warning_period = 5.0;

bool is_latched(const ros::MessageEvent<const sensor_msgs::PointCloud2>& event) {
  const ros::M_string& header = event.getConnectionHeader();
  const auto latching = header.find("latching");
  return latching != header.end() && latching->second == "1";
}

bool remove_cloud(fiber::World& world) {
  if (!world.has(fiber::cloud_name)) {
    return false;
  }
  world.apply({removal_of(fiber::cloud_name)});
  return true;
}

}  // namespace

CloudInput::CloudInput(ros::NodeHandle private_node, const CloudOptions& options, double tf_timeout,
                       double max_stamp_ahead, std::function<void()> on_message)
    : resolution_(options.resolution),
      decay_(options.decay),
      timeout_(options.timeout),
      required_(options.required),
      tf_timeout_(tf_timeout),
      max_stamp_ahead_(max_stamp_ahead),
      on_message_(std::move(on_message)),
      log_(private_node.resolveName("cloud"), "sensor_msgs/PointCloud2"),
      cells_(options),
      subscriber_(private_node.subscribe("cloud", 1, &CloudInput::receive, this,
                                         ros::TransportHints().tcpNoDelay())) {}

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

std::optional<Unknown> CloudInput::unknown(const ros::Time& now) const {
  const auto because = [this](const std::string& why) {
    const std::string& refused = log_.refused_since();
    return Unknown{log_.statistics().topic, fiber::cloud_name, last_use_,
                   why + (refused.empty() ? "" : ", the last one was refused: " + refused)};
  };
  if (required_ && newest_.stamp.isZero()) {
    return because("no cloud yet");
  }
  if (required_ && timeout_ > 0.0 && !newest_.is_latched && (now - last_use_).toSec() > timeout_) {
    std::ostringstream why;
    why << "no new cloud for " << timeout_ << " s (cloud/timeout)";
    return because(why.str());
  }
  if (required_ && has_decayed(now)) {
    std::ostringstream why;
    why << "all cells have decayed: no new cloud for " << decay_ << " s (cloud/decay)";
    return because(why.str());
  }
  const CloudCounts& counts = newest_.counts;
  const bool is_blind = counts.used() == 0 && counts.not_finite > 0;
  if (is_blind || counts.too_far > 0) {
    return because("of its " + std::to_string(counts.points) + " point(s) " +
                   reasons_of(counts, resolution_));
  }
  return std::nullopt;
}

void CloudInput::receive(const ros::MessageEvent<const sensor_msgs::PointCloud2>& event) {
  log_.receive();
  if (next_) {
    log_.overtake();
  }
  (waiting_ ? next_ : waiting_) =
      Cloud{event.getConstMessage(), is_latched(event), ros::SteadyTime::now()};
  on_message_();
}

bool CloudInput::place_waiting(FixedFrame& frame) {
  std_msgs::Header header = waiting_->message->header;
  header.frame_id = tf2_name(header.frame_id);
  if (header.frame_id.empty()) {
    log_.refuse("header.frame_id is empty, it must name the frame of the points");
    return true;
  }
  const ros::Time now = ros::Time::now();
  const ros::Time stamp = header.stamp.isZero() ? now : header.stamp;
  try {
    validate_stamp(stamp, now, max_stamp_ahead_);
    if (frame.name().empty()) {  // which one that cannot be used must not choose
      FiberBuffer buffer;
      to_chains(*waiting_->message, buffer);
      frame.adopt(header.frame_id);
    }
    MakeResult make = [this, cloud = *waiting_, pose = frame.transform_from(header), stamp] {
      return use(cloud, pose, stamp);
    };
    if (std::exchange(placed_, std::move(make))) {
      log_.overtake();
    }
    return true;
  } catch (const std::invalid_argument& error) {
    log_.refuse(error.what());
    return true;
  } catch (const TransformUnavailable& error) {
    if ((ros::SteadyTime::now() - waiting_->arrival).toSec() <= tf_timeout_) {
      return false;
    }
    log_.refuse(error.what());
    return true;
  }
}

/// Makes an octree of a cloud that was seen from this pose.
CloudInput::Result CloudInput::use(const Cloud& cloud, const Eigen::Isometry3d& pose,
                                   const ros::Time& stamp) {
  FiberBuffer buffer;
  to_chains(*cloud.message, buffer);
  const CloudCounts counts = cells_.add(buffer.points, pose, stamp.toSec());
  return {cells_.octree(), counts, stamp, cloud.is_latched};
}

bool CloudInput::take_result(fiber::World& world) {
  const ros::Time before = newest_.stamp;
  try {
    newest_ = std::exchange(in_work_, std::nullopt)->get();
  } catch (const std::exception& error) {
    log_.refuse(error.what());
    return false;
  }
  if (newest_.stamp != before) {  // the same again is of a camera that has frozen
    last_use_ = ros::Time::now();
  }
  log_.accept();
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
    ROS_WARN_STREAM_THROTTLE(unused_warning_period,
                             log_.label()
                                 << ": none of its " << counts.points
                                 << " point(s) is used: " << reasons_of(counts, resolution_));
  }
}

bool CloudInput::has_decayed(const ros::Time& now) const {
  return decay_ > 0.0 && !newest_.stamp.isZero() && (now - newest_.stamp).toSec() > decay_;
}

bool CloudInput::remove_decayed(const ros::Time& now, fiber::World& world) {
  return has_decayed(now) && remove_cloud(world);
}

bool CloudInput::reset(const ros::Time& now, fiber::World& world) {
  placed_.reset();
  in_work_.reset();
  newest_ = {};
  last_use_ = now;
  return remove_cloud(world);
}

}  // namespace fiber_proximity_ros
