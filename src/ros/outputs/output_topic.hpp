#pragma once

#include <ros/node_handle.h>
#include <ros/single_subscriber_publisher.h>

#include <boost/shared_ptr.hpp>
#include <functional>
#include <string>

#include "src/ros/support/pool.hpp"

namespace fiber_proximity_ros {

/// Is called when somebody begins to listen to one of our topics: what is published when messages
/// arrive may be long in coming, so that the newest answer is given once more.
using Newcomer = std::function<void()>;

/// A topic whose newest message alone counts. Nodelets of the same manager get the message itself,
/// not a copy; when all of them have let go of it, its memory serves again.
template <class Message>
class OutputTopic {
 public:
  explicit OutputTopic(const ros::Publisher& publisher = {}) : publisher_(publisher) {}

  OutputTopic(ros::NodeHandle node, const std::string& topic, const Newcomer& on_newcomer)
      : OutputTopic(node.advertise<Message>(
            topic, 1, [on_newcomer](const ros::SingleSubscriberPublisher&) { on_newcomer(); })) {}

  bool has_listeners() const { return publisher_.getNumSubscribers() > 0; }

  /// The message that publish() sends: as an earlier one was left, to be written as a whole.
  Message& message() {
    if (message_ == nullptr) {
      // Whoever keeps more of them than this may have them.
      constexpr std::size_t max_shared = 8;
      if (messages_.size() == max_shared) {
        messages_.clear();
      }
      message_ = messages_.take();
    }
    return *message_;
  }

  /// Sends message(), to which nobody writes any more.
  void publish() {
    message();
    publisher_.publish(message_);
    message_.reset();
  }

 private:
  ros::Publisher publisher_;
  Pool<Message, boost::shared_ptr> messages_;
  boost::shared_ptr<Message> message_;  // until it is published
};

}  // namespace fiber_proximity_ros
