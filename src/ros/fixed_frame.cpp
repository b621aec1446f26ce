#include "fiber_proximity/ros/fixed_frame.hpp"

#include <ros/console.h>
#include <tf2/exceptions.h>

#include <sstream>
#include <utility>

namespace fiber_proximity_ros {
namespace {

Eigen::Isometry3d to_isometry(const geometry_msgs::Transform& transform) {
  const geometry_msgs::Vector3& p = transform.translation;
  const geometry_msgs::Quaternion& q = transform.rotation;
  // tf lets quaternions through that are a little off unit length; they must not scale a cable.
  return Eigen::Translation3d(p.x, p.y, p.z) * Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
}

std::string time_of(const ros::Time& stamp) {
  if (stamp.isZero()) {
    return "";
  }
  std::ostringstream text;
  text << " at time " << stamp;
  return text.str();
}

}  // namespace

FixedFrame::FixedFrame(std::string name, const ros::NodeHandle& node)
    : name_(std::move(name)), listener_(buffer_, node) {}

void FixedFrame::adopt(const std::string& frame) {
  if (name_.empty() && !frame.empty()) {
    name_ = frame;
    ROS_INFO_STREAM("fixed_frame is not set: using '" << name_ << "', the frame of the first "
                                                      << "message");
  }
}

void FixedFrame::place(const std_msgs::Header& header, fiber::FiberAssembly& fibers,
                       std::vector<Eigen::Vector3d>& buffer) const {
  if (header.frame_id == name_) {
    return;
  }
  const Eigen::Isometry3d transform = transform_from(header);
  buffer.clear();
  for (const Eigen::Vector3d& point : fibers.points()) {
    buffer.push_back(transform * point);
  }
  fibers.update_points(buffer);
}

Eigen::Isometry3d FixedFrame::transform_from(const std_msgs::Header& header) const {
  const std::string what = "no transform from frame '" + header.frame_id + "' to '" + name_ + "'" +
                           time_of(header.stamp) + ": ";
  try {
    return to_isometry(buffer_.lookupTransform(name_, header.frame_id, header.stamp).transform);
  } catch (const tf2::LookupException& error) {
    throw TransformUnavailable(what + "unknown frame: " + error.what());
  } catch (const tf2::ConnectivityException& error) {
    throw TransformUnavailable(what + "frames not connected: " + error.what());
  } catch (const tf2::ExtrapolationException& error) {
    throw TransformUnavailable(what + "not known at that time: " + error.what());
  } catch (const tf2::TransformException& error) {
    throw TransformUnavailable(what + error.what());
  }
}

}  // namespace fiber_proximity_ros
