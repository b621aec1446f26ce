#pragma once

#include <deque>
#include <string>
#include <vector>

#include "src/ros/inputs/fiber_message.hpp"
#include "src/ros/inputs/fixed_frame.hpp"
#include "src/ros/inputs/input_source.hpp"
#include "src/ros/inputs/message_log.hpp"

namespace fiber_proximity_ros {

/// Messages of one input that wait for their transforms.
///
/// Few messages wait: the first keeps its turn until its transform arrives or `tf_timeout` is over,
/// so that a slow tf delays fibres but never starves them; where there is no more room, the newest
/// one replaces the one before it.
class TransformQueue {
 public:
  /// @param log must outlive this
  TransformQueue(const InputTiming& timing, MessageLog& log) : timing_(timing), log_(log) {}

  void add(FiberMessagePtr message);

  /// Brings what waits into the fixed frame where tf has the transform by now: the newest only, or
  /// all of them if inputs are synchronised.
  /// @returns those that are in the fixed frame now, in their order
  std::vector<FiberMessagePtr> place(const FixedFrame& frame);

  void clear() { waiting_.clear(); }
  bool is_empty() const { return waiting_.empty(); }

 private:
  bool place(FiberMessagePtr& message, const FixedFrame& frame);

  InputTiming timing_;
  MessageLog& log_;
  std::deque<FiberMessagePtr> waiting_;
  std::string transform_error_;  // why the last one that was tried has no transform
};

}  // namespace fiber_proximity_ros
