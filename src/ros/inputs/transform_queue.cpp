#include "src/ros/inputs/transform_queue.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace fiber_proximity_ros {

void TransformQueue::add(FiberMessagePtr message) {
  if (waiting_.size() == timing_.queue_size()) {
    log_.overtake();
    waiting_.pop_back();
  }
  waiting_.push_back(std::move(message));
}

std::vector<FiberMessagePtr> TransformQueue::place(const FixedFrame& frame) {
  // The loop goes from the newest to the oldest. Messages before a placed one have lost their turn.
  // Where inputs are synchronised they are placed, too: the others' messages may belong to them.
  std::vector<FiberMessagePtr> placed;
  for (auto message = waiting_.rbegin(); message != waiting_.rend(); ++message) {
    if ((placed.empty() || timing_.synchronize) && place(*message, frame)) {
      placed.push_back(std::move(*message));
    } else if (!placed.empty() && *message != nullptr) {
      log_.overtake();
      message->reset();
    }
  }
  waiting_.erase(std::remove(waiting_.begin(), waiting_.end(), nullptr), waiting_.end());
  if (!waiting_.empty() &&
      (ros::SteadyTime::now() - waiting_.front()->steady_arrival).toSec() > timing_.tf_timeout) {
    waiting_.pop_front();
    log_.refuse(transform_error_);
  }
  std::reverse(placed.begin(), placed.end());
  return placed;
}

/// @returns true if the message is now in the fixed frame; one that cannot be is gone then
bool TransformQueue::place(FiberMessagePtr& message, const FixedFrame& frame) {
  try {
    frame.place(message->header, message->fibers);
    return true;
  } catch (const TransformUnavailable& error) {
    transform_error_ = error.what();
  } catch (const std::invalid_argument& error) {
    message.reset();
    log_.refuse(error.what());
  }
  return false;
}

}  // namespace fiber_proximity_ros
