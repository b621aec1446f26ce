#pragma once

#include <ros/time.h>

#include <optional>

#include "src/ros/inputs/fiber_message.hpp"
#include "src/ros/inputs/input_source.hpp"

namespace fiber_proximity_ros {

/// The stamps and arrivals of one input's messages: which stamp the next one may have, and whether
/// the input has fallen silent.
class InputStamps {
 public:
  explicit InputStamps(const InputTiming& timing) : timing_(timing) {}

  /// @throws std::invalid_argument for a stamp too far ahead, or older than that of the message
  ///         before; a recording that starts again is let through after `input_timeout`
  void check(const ros::Time& stamp, const ros::Time& now) const;

  /// Whether a message only repeats the last one that was placed, as a tracker does that has
  /// frozen.
  /// @param header_stamp as the message has it
  bool repeats(const ros::Time& header_stamp, bool is_news);

  /// Notes a message that is in, and one that is in the fixed frame as well.
  void receive(const FiberMessage& message);
  void place(const FiberMessage& message);

  /// True if no usable message has come for `input_timeout`.
  bool is_silent(const ros::Time& now) const;

  /// Whether the last message was a repetition.
  bool is_repeating() const { return is_repeating_; }

  const std::optional<ros::Time>& last_received() const { return last_stamp_; }
  bool has_placed() const { return placed_arrival_.has_value(); }

  /// When the last message arrived that was placed, or since when one is waited for.
  const ros::Time& known_since() const { return placed_arrival_ ? *placed_arrival_ : beginning_; }

 private:
  InputTiming timing_;
  ros::Time beginning_ = ros::Time::now();
  bool is_repeating_ = false;
  // Empty where there was no such message yet.
  std::optional<ros::Time> last_stamp_;
  std::optional<ros::Time> last_arrival_;
  std::optional<ros::Time> placed_header_stamp_;
  std::optional<ros::Time> placed_arrival_;
};

}  // namespace fiber_proximity_ros
