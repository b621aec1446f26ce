#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/inputs/fiber_message.hpp"
#include "src/ros/support/pool.hpp"

namespace fiber_proximity_ros {

/// The placed fibres of several inputs as those of one message. Where one input has fibres, its
/// message is the merged one, and nothing is copied.
class MergedFibers {
 public:
  /// Makes it the fibres of these messages, in their order. What message() has returned before
  /// stays as it is.
  void merge(const std::vector<FiberMessagePtr>& messages);

  /// Without an input its fibres are none; its stamp is the newest.
  const std::shared_ptr<const FiberMessage>& message() const { return message_; }

 private:
  FiberBuffer buffer_;  // a member for its memory
  Pool<FiberMessage> pool_;
  std::shared_ptr<const FiberMessage> message_ = std::make_shared<const FiberMessage>();
};

}  // namespace fiber_proximity_ros
