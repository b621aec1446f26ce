#pragma once

#include <ros/node_handle.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "fiber_proximity/ros/fiber_buffer.hpp"
#include "src/ros/inputs/input_options.hpp"

namespace fiber_proximity_ros {

/// True for the types that MarkerInputOptions apply to.
/// @throws std::invalid_argument for an unknown type, listing those known
bool is_marker_type(const std::string& type);

/// Reads the fibres of one message, in the message's frame.
/// Returns false if the message holds none for this input; throws std::invalid_argument if it is
/// malformed.
using ReadMessage = std::function<bool(FiberBuffer& chains)>;

/// A message as it arrives.
struct ReceivedMessage {
  ReadMessage read;
  std::string publisher;                  ///< name of the node that has sent it
  std::optional<std::uint32_t> sequence;  ///< its header.seq; none where roscpp numbers none
};

/// Subscribes to the input's topic; the receiver is called once per message, of which the newest is
/// kept while it is busy.
/// @throws std::invalid_argument for an unknown type
ros::Subscriber subscribe(ros::NodeHandle& node, const InputOptions& options,
                          const std::function<void(const ReceivedMessage&)>& receiver);

}  // namespace fiber_proximity_ros
