#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <ros/node_handle.h>
#include <std_msgs/Header.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <Eigen/Geometry>
#include <stdexcept>
#include <string>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/text/with_context.hpp"

namespace fiber_proximity_ros {

/// tf has no transform; it may have one later. The message says what is missing.
class TransformUnavailable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Name of a frame as tf2 knows it: without the slash in front that tf1 had.
std::string tf2_name(const std::string& frame_id);

/// Where a frame is, and when it was there; a zero stamp: always.
struct FramePose {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  ros::Time stamp;
};

/// The frame everything is brought into. Frames are given to it with or without the slash in front.
class FixedFrame {
 public:
  /// @param name empty: the frame that is adopted first
  FixedFrame(const std::string& name, const ros::NodeHandle& node);

  /// Empty until a frame is configured or adopted.
  const std::string& name() const { return name_; }

  /// Takes this frame if there is none yet.
  void adopt(const std::string& frame);

  /// Brings fibres that are in the header's frame at its stamp into this frame; a zero stamp means
  /// the latest transform. Does not wait.
  /// @throws TransformUnavailable
  /// @throws std::invalid_argument for points that leave the range of coordinates on the way
  void place(const std_msgs::Header& header, fiber::FiberAssembly& fibers) const;

  /// Pose of the header's frame in this one at its stamp; a zero stamp means the latest transform,
  /// an empty frame this one. Does not wait.
  /// @throws TransformUnavailable
  Eigen::Isometry3d transform_from(const std_msgs::Header& header) const;

  /// Whether transform_from() would give a pose.
  bool knows(const std_msgs::Header& header) const;

  /// Pose of a frame in this one at a time, or the latest one where tf does not know that.
  /// @throws TransformUnavailable where tf knows none at all
  FramePose latest_pose(const std::string& frame_id, const ros::Time& stamp) const;

 private:
  geometry_msgs::TransformStamped look_up(const std_msgs::Header& header) const;

  std::string name_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
};

/// fiber::with_context(), for functions that may miss a transform, too.
template <class Function>
auto naming(const std::string& what, const Function& function) {
  try {
    return fiber::with_context(what, function);
  } catch (const TransformUnavailable& error) {
    throw TransformUnavailable(what + ": " + error.what());
  }
}

/// Whether a frame is a camera's optical one (REP 103: x to the right, y down, z forwards), which
/// its name says.
inline bool is_optical_frame(const std::string& frame) {
  return frame.find("optical") != std::string::npos;
}

}  // namespace fiber_proximity_ros
