#pragma once

#include <ros/node_handle.h>
#include <ros/single_subscriber_publisher.h>

#include <functional>
#include <string>

namespace fiber_proximity_ros {

/// Is called when somebody begins to listen to one of our topics: what is published when messages
/// arrive may be long in coming, so that the newest answer is given once more.
using Newcomer = std::function<void()>;

/// A topic whose newest message alone counts. The message is kept for its memory.
template <class Message>
class OutputTopic {
 public:
  OutputTopic(ros::NodeHandle node, const std::string& topic, const Newcomer& on_newcomer)
      : publisher_(node.advertise<Message>(
            topic, 1, [on_newcomer](const ros::SingleSubscriberPublisher&) { on_newcomer(); })) {}

  bool has_listeners() const { return publisher_.getNumSubscribers() > 0; }

  /// The message that publish() sends.
  Message& message() { return message_; }

  void publish() const { publisher_.publish(message_); }

 private:
  ros::Publisher publisher_;
  Message message_;
};

}  // namespace fiber_proximity_ros
