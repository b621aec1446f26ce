#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <boost/make_shared.hpp>
#include <cstdint>
#include <functional>
#include <utility>

namespace fiber_proximity_ros {

/// A function in a callback queue.
class CallbackTask : public ros::CallbackInterface {
 public:
  explicit CallbackTask(std::function<void()> function) : function_(std::move(function)) {}
  CallResult call() override {
    function_();
    return Success;
  }

 private:
  std::function<void()> function_;
};

/// The queue that a node handle's callbacks come from.
inline ros::CallbackQueueInterface& queue_of(const ros::NodeHandle& node) {
  ros::CallbackQueueInterface* queue = node.getCallbackQueue();
  return queue != nullptr ? *queue : *ros::getGlobalCallbackQueue();
}

/// Has a function called from a queue, behind what is in it already.
/// @param owner for ros::CallbackQueueInterface::removeByID
inline void add_task(ros::CallbackQueueInterface& queue, const void* owner,
                     std::function<void()> function) {
  queue.addCallback(boost::make_shared<CallbackTask>(std::move(function)),
                    reinterpret_cast<std::uintptr_t>(owner));
}

/// Takes what add_task() has put there, if it has not been called.
inline void remove_tasks(ros::CallbackQueueInterface& queue, const void* owner) {
  queue.removeByID(reinterpret_cast<std::uintptr_t>(owner));
}

}  // namespace fiber_proximity_ros
