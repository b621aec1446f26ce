#include "src/ros/inputs/fixed_frame.hpp"

#include <ros/console.h>
#include <tf2/exceptions.h>

#include <sstream>

#include "src/text/quote.hpp"

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

std::string tf2_name(const std::string& frame_id) {
  return frame_id.substr(!frame_id.empty() && frame_id.front() == '/' ? 1 : 0);
}

FixedFrame::FixedFrame(const std::string& name, const ros::NodeHandle& node)
    : name_(tf2_name(name)), listener_(buffer_, node, true, ros::TransportHints().tcpNoDelay()) {}

void FixedFrame::adopt(const std::string& frame) {
  if (name_.empty() && !frame.empty()) {
    name_ = tf2_name(frame);
    ROS_INFO_STREAM("fixed_frame is not set: using " << fiber::quote(name_)
                                                     << ", the frame of the first message");
  }
}

void FixedFrame::place(const std_msgs::Header& header, fiber::FiberAssembly& fibers) const {
  if (tf2_name(header.frame_id) != name_) {
    fibers.transform(transform_from(header));
  }
}

Eigen::Isometry3d FixedFrame::transform_from(const std_msgs::Header& header) const {
  if (header.frame_id.empty() || tf2_name(header.frame_id) == name_) {
    return Eigen::Isometry3d::Identity();
  }
  return to_isometry(look_up(header).transform);
}

bool FixedFrame::knows(const std_msgs::Header& header) const {
  const std::string frame = tf2_name(header.frame_id);
  return frame.empty() || frame == name_ ||
         (!name_.empty() && buffer_.canTransform(name_, frame, header.stamp));
}

FramePose FixedFrame::latest_pose(const std::string& frame_id, const ros::Time& stamp) const {
  const std::string frame = tf2_name(frame_id);
  if (frame == name_) {
    return {};
  }
  std_msgs::Header header;
  header.frame_id = frame;
  if (!name_.empty() && buffer_.canTransform(name_, frame, stamp)) {
    header.stamp = stamp;
  }
  const geometry_msgs::TransformStamped transform = look_up(header);
  return {to_isometry(transform.transform), transform.header.stamp};
}

geometry_msgs::TransformStamped FixedFrame::look_up(const std_msgs::Header& header) const {
  if (name_.empty()) {
    throw TransformUnavailable(
        "no transform from frame " + fiber::quote(header.frame_id) +
        ": there is no fixed frame yet, set the parameter fixed_frame or wait "
        "for a message that names one");
  }
  const std::string frame = tf2_name(header.frame_id);
  const std::string what = "no transform from frame " + fiber::quote(frame) + " to " +
                           fiber::quote(name_) + time_of(header.stamp) + ": ";
  try {
    return buffer_.lookupTransform(name_, frame, header.stamp);
  } catch (const tf2::LookupException&) {
    // tf names the first frame that it lacks. That is the fixed one as long as nobody has
    // published.
    const bool knows_fixed = buffer_._frameExists(name_);
    throw TransformUnavailable(
        what + "unknown frame: " +
        (buffer_._frameExists(frame)
             ? fiber::quote(name_)
             : fiber::quote(frame) + (knows_fixed ? "" : ", and so is " + fiber::quote(name_))));
  } catch (const tf2::ConnectivityException& error) {
    throw TransformUnavailable(what + "frames not connected: " + error.what());
  } catch (const tf2::ExtrapolationException& error) {
    throw TransformUnavailable(what + "not known at that time: " + error.what());
  } catch (const tf2::TransformException& error) {
    throw TransformUnavailable(what + error.what());
  }
}

}  // namespace fiber_proximity_ros
