#pragma once

#include <ros/node_handle.h>
#include <std_msgs/Header.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <Eigen/Geometry>
#include <stdexcept>
#include <string>

namespace fiber_proximity_ros {

/// tf has no transform; it may have one later. The message says what is missing.
class TransformUnavailable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The frame everything is brought into.
class FixedFrame {
 public:
  /// @param name empty: the frame that is adopted first
  FixedFrame(std::string name, const ros::NodeHandle& node);

  /// Empty until a frame is configured or adopted.
  const std::string& name() const { return name_; }

  /// Takes this frame if there is none yet.
  void adopt(const std::string& frame);

  /// True for points that need no transform.
  bool is(const std::string& frame) const { return frame == name_; }

  /// The transform of points in the header's frame at its stamp; a zero stamp means the latest one.
  /// Does not wait.
  /// @throws TransformUnavailable
  Eigen::Isometry3d transform_from(const std_msgs::Header& header) const;

 private:
  std::string name_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
};

}  // namespace fiber_proximity_ros
