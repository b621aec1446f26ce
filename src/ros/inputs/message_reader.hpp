#pragma once

#include <string>
#include <vector>

#include "src/ros/inputs/fiber_message.hpp"
#include "src/ros/inputs/input_source.hpp"
#include "src/ros/inputs/input_stamps.hpp"
#include "src/ros/inputs/missing_points.hpp"
#include "src/ros/support/pool.hpp"

namespace fiber_proximity_ros {

/// Reads the messages of one input: names their fibres, bridges their missing points or cuts at
/// them, and refuses what is malformed. Points go from the message into the assembly in one copy.
class MessageReader {
 public:
  explicit MessageReader(const InputOptions& options) : options_(options) {}

  /// @returns null if the message does not count: it holds nothing for this input, or nothing new
  /// @throws std::invalid_argument for a malformed message, or a stamp that cannot be
  FiberMessagePtr read(const ReadMessage& read, InputStamps& stamps);

  /// Remarks about the message read last, which the log is to be told once.
  const std::vector<std::string>& remarks() const { return remarks_; }

  /// Counts of missing points in all messages so far.
  const MissingPointCounts& missing() const { return missing_; }

  /// The message is held by another thread, too, so that its memory is not used again.
  void share(const FiberMessagePtr& message) { pool_.forget(message); }

  /// Gives back the memory of what was read.
  void release();

 private:
  const InputOptions& options_;
  MissingPointCounts missing_;
  std::vector<std::string> remarks_;
  FiberBuffer buffer_;  // a member for its memory
  Pool<FiberMessage> pool_;
};

}  // namespace fiber_proximity_ros
