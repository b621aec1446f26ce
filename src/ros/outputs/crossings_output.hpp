#pragma once

#include <ros/node_handle.h>
#include <std_msgs/Header.h>

#include <string>
#include <vector>

#include "fiber_proximity/CrossingArray.h"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/crossings.hpp"
#include "src/ros/inputs/fixed_frame.hpp"
#include "src/ros/outputs/output_topic.hpp"

namespace fiber_proximity_ros {

/// Over and under crossings of the node's fibres, on ~crossings.
///
/// The map ~crossings of parameters says how they are looked at: `direction`, three numbers in the
/// fixed frame along parallel rays, [0, 0, -1] by default; or `camera_frame`, seen from that
/// frame's origin along its z axis, as in an optical frame. The camera is where it was at the
/// fibres' stamp or, while tf does not know that, where it was last; as long as tf knows nothing of
/// it, nothing is published and a warning says why.
class CrossingsOutput {
 public:
  /// Refers to the frame, which must outlive it.
  /// @throws std::invalid_argument for a bad parameter
  CrossingsOutput(const ros::NodeHandle& private_node, const FixedFrame& frame,
                  const Newcomer& on_newcomer);

  /// Whether anybody listens.
  bool is_wanted() const { return topic_.has_listeners(); }

  /// There are other fibres from now on, whose crossings are found when they are first wanted.
  void forget() { is_found_ = false; }

  /// Finds the crossings and publishes them.
  /// @param header of the fibres, in the fixed frame
  /// @param names  one per fibre
  void publish(const fiber::FiberAssembly& fibers, const std_msgs::Header& header,
               const std::vector<std::string>& names);

  /// Finds the crossings, for drawing.
  /// @returns false, without any, if it is unknown where the camera is
  bool find(const fiber::FiberAssembly& fibers, const std_msgs::Header& header);

  /// The crossings that the last find() or publish() has found.
  const std::vector<fiber::Crossing>& crossings() const { return crossings_; }
  /// The view in which they were found.
  const fiber::View& view() const { return view_; }

 private:
  void read_parameters(const ros::NodeHandle& private_node);

  const FixedFrame& frame_;
  std::string camera_frame_;  // empty: parallel rays
  fiber::View view_;
  fiber::CrossingFinder finder_;
  std::vector<fiber::Crossing> crossings_;
  bool is_found_ = false;
  OutputTopic<fiber_proximity::CrossingArray> topic_;
};

}  // namespace fiber_proximity_ros
