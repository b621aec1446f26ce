#pragma once

#include <ros/node_handle.h>
#include <ros/single_subscriber_publisher.h>

#include <functional>
#include <string>

namespace fiber_proximity_ros {

/// Told that somebody has begun to listen to one of our topics: what is published when messages
/// arrive may be long in coming, so that the newest answer is given once more.
using Newcomer = std::function<void()>;

/// A topic whose newest message alone counts.
template <class Message>
ros::Publisher advertise(ros::NodeHandle& node, const std::string& topic,
                         const Newcomer& on_newcomer) {
  return node.advertise<Message>(
      topic, 1, [on_newcomer](const ros::SingleSubscriberPublisher&) { on_newcomer(); });
}

}  // namespace fiber_proximity_ros
