#pragma once

#include <ros/time.h>

#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/InputStatistics.h"
#include "src/ros/inputs/fiber_message.hpp"
#include "src/ros/inputs/fiber_speeds.hpp"
#include "src/ros/inputs/fixed_frame.hpp"
#include "src/ros/inputs/input_budget.hpp"
#include "src/ros/inputs/input_source.hpp"
#include "src/ros/inputs/input_stamps.hpp"
#include "src/ros/inputs/message_log.hpp"
#include "src/ros/inputs/message_reader.hpp"
#include "src/ros/inputs/publishers.hpp"
#include "src/ros/inputs/transform_queue.hpp"
#include "src/ros/support/unknown.hpp"

namespace fiber_proximity_ros {

/// One source of fibres. Its messages are read (MessageReader), wait for their transforms
/// (TransformQueue), are tried where they may cost too much (FiberTrial), and are then accepted:
/// at once, or with those of the other inputs if these are synchronised. It knows how old its
/// fibres are.
class Input {
 public:
  /// @param worker tries fibres that may cost too much; it must end before the input
  Input(InputOptions options, const InputTiming& timing, Worker& worker);
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  /// Takes the newest message. A malformed one is refused and changes nothing.
  void receive(const ReceivedMessage& message, FixedFrame& frame);

  /// Brings what waits into the fixed frame where tf has the transform by now: the newest only, or
  /// all of them if inputs are synchronised. Those that may cost too much are tried first.
  /// @param answered what the node asks about fibres
  /// @returns the stamps of those that may be accepted now, too; they do not decrease
  std::vector<ros::Time> place_waiting(const FixedFrame& frame,
                                       const fiber::QueryOptions& answered);

  /// Makes the fibres those of the message with this stamp, which place_waiting() has returned;
  /// those before it are overtaken.
  void accept(const ros::Time& stamp);

  /// Marks the fibres stale when they were not renewed for `input_timeout`, or when the messages
  /// belong to none of the other inputs.
  /// @returns true if they have just become so
  bool expire(const ros::Time& now, bool is_unmatched);

  /// Forgets all fibres, as when time starts again.
  void reset();

  bool is_waiting() const { return !transforms_.is_empty() || trial_.is_running(); }

  /// An answer has taken so long [s].
  void doubt(double time) { trial_.budget().doubt(time); }

  /// Whether its fibres were left out since this was last asked, as they cost too much.
  bool take_left_out() { return std::exchange(was_left_out_, false); }

  /// True if there are fibres and they are not stale: these may be used.
  bool is_fresh() const { return has_fibers_ && !staleness_; }

  /// True if no usable message has come for `input_timeout`.
  bool is_silent(const ros::Time& now) const { return stamps_.is_silent(now); }

  /// The message accepted last, in the fixed frame.
  const FiberMessagePtr& message() const { return current_; }
  const fiber::FiberAssembly& fibers() const { return current_->fibers; }
  const std::vector<std::string>& names() const { return current_->names; }

  /// Stamp of the fibres: the time of their arrival where the message has none.
  const ros::Time& stamp() const { return current_->stamp; }

  const InputOptions& options() const { return options_; }

  /// [m] How far a true point of this fibre may be from the told one at this time.
  double uncertainty(std::size_t fiber, const ros::Time& now) const;
  fiber_proximity::InputStatistics statistics(const ros::Time& now) const;

  /// Why the fibres are stale; empty if they are not.
  std::string stale_reason() const { return staleness_ ? staleness_->reason : ""; }

  /// Tells whether its fibres, or some of their points, are not known now, which makes answers
  /// incomplete. An input that is not required lacks points at most.
  std::optional<Unknown> unknown() const;

 private:
  /// Why the fibres are stale: no message comes, or those that come match no other input's.
  struct Staleness {
    bool is_silent;
    std::string reason;
  };

  std::vector<FiberMessagePtr> take_placed(const FixedFrame& frame);
  void overtake_placed(std::size_t left);
  void leave_out();
  std::string silence() const;
  std::string mismatch() const;
  std::string absence() const;

  InputOptions options_;
  InputTiming timing_;
  MessageLog log_;
  Publishers publishers_;
  InputStamps stamps_;
  MessageReader reader_;
  TransformQueue transforms_;
  FiberTrial trial_;
  std::deque<FiberMessagePtr> placed_;  // in the fixed frame, to be accepted
  FiberMessagePtr current_ = std::make_shared<FiberMessage>();
  FiberSpeeds speeds_;  // where latency makes fibres uncertain
  bool has_fibers_ = false;
  bool was_left_out_ = false;
  std::optional<Staleness> staleness_;
};

}  // namespace fiber_proximity_ros
