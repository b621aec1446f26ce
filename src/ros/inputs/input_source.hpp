#pragma once

#include <ros/console.h>
#include <ros/exceptions.h>
#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/inputs/input_budget.hpp"
#include "src/ros/inputs/marker_input.hpp"
#include "src/ros/inputs/missing_points.hpp"

namespace fiber_proximity_ros {

/// One source of fibres: an entry of the parameter `~inputs`.
struct InputOptions {
  std::string topic;
  std::string type;  ///< of its messages, one that subscribe() knows

  /// Name of the fibre where the message does not name it. Several fibres are called name/0,
  /// name/1, ... An empty name stands for the topic.
  std::string name;

  double radius{};  ///< [m] where the message has none

  /// [m] Every true point is at most this far from the one that the message tells.
  double uncertainty{};

  bool close_rings{};  ///< fibres that end where they begin are closed

  MissingPoints missing_points = MissingPoints::REFUSE;

  bool required = true;  ///< answers without its fibres are incomplete

  CostLimits cost;

  MarkerInputOptions marker;  ///< used by the marker types

  std::string where;  ///< what the log calls the entry
};

/// When an input's messages and fibres expire, which stamps they may have, and whose belong
/// together; the defaults are in cfg/interface.yaml.
struct InputTiming {
  /// [s] of wall time a message may wait for its transform; longer than tf takes to arrive
  double tf_timeout{};

  /// [s] of ROS time after which fibres that were not renewed are left out; several periods of any
  /// camera
  double input_timeout{};

  /// [s] a stamp may be ahead of the node's time; more than the clocks of one robot differ
  double max_stamp_ahead{};

  /// True: the fibres of all inputs change together, to those whose stamps belong together.
  bool synchronize{};

  /// [s] most by which stamps that belong together differ; more than a period of a usual camera
  double synchronize_slop{};

  /// True: what fibres may have moved since their stamps makes them uncertain.
  bool bounds_latency{};

  /// Messages of one input that wait, for their transforms or for those of the other inputs.
  /// Without synchronisation one keeps its turn, and the newest stands behind it.
  std::size_t queue_size() const { return synchronize ? 10 : 2; }
};

/// Reads one entry of the list; keys that are absent have the defaults of
/// cfg/interface.yaml.
/// @throws std::invalid_argument naming key, value and what is allowed
InputOptions read_input_options(const XmlRpc::XmlRpcValue& entry, double default_radius);

/// Reads the fibres of one message, in the message's frame; throws std::invalid_argument if it is
/// malformed.
using ReadMessage = std::function<ReadResult(FiberBuffer& fibers)>;

/// A message as it arrives.
struct ReceivedMessage {
  ReadMessage read;
  std::function<void()> keep;             ///< to be called if it is not refused
  std::string publisher;                  ///< name of the node that has sent it
  std::optional<std::uint32_t> sequence;  ///< its header.seq; none where roscpp numbers none
};

using Receiver = std::function<void(const ReceivedMessage&)>;

/// Subscribes to the input's topic; the receiver is called once per message, of which the newest is
/// kept while it is busy.
/// @throws std::invalid_argument for an unknown type
ros::Subscriber subscribe(ros::NodeHandle& node, const InputOptions& options,
                          const Receiver& receiver);

/// Calls a function that subscribes to a topic that somebody has configured. A topic has one type
/// in a process: where another part of it, or another nodelet, has subscribed with another type,
/// this one is left out, and the log says so.
/// @param where what the log calls what is left out
/// @returns false if it is left out
template <class Subscribe>
bool subscribes(const std::string& where, const Subscribe& subscribe) {
  try {
    subscribe();
    return true;
  } catch (const ros::ConflictingSubscriptionException& error) {
    ROS_ERROR_STREAM(where << " is left out: its topic is subscribed to with another type already: "
                           << error.what());
    return false;
  }
}

}  // namespace fiber_proximity_ros
