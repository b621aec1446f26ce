#pragma once

#include <ros/node_handle.h>
#include <std_msgs/Header.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <Eigen/Geometry>
#include <stdexcept>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

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

  /// Brings fibres that are in the header's frame at its stamp into this frame; a zero stamp means
  /// the latest transform. Does not wait.
  /// @param buffer only for its memory, which is reused
  /// @throws TransformUnavailable
  /// @throws std::invalid_argument for points that leave the range of coordinates on the way
  void place(const std_msgs::Header& header, fiber::FiberAssembly& fibers,
             std::vector<Eigen::Vector3d>& buffer) const;

 private:
  Eigen::Isometry3d transform_from(const std_msgs::Header& header) const;

  std::string name_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
};

}  // namespace fiber_proximity_ros
