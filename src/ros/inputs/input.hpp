#pragma once

#include <ros/time.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/InputStatistics.h"
#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/inputs/fixed_frame.hpp"
#include "src/ros/inputs/input_budget.hpp"
#include "src/ros/inputs/input_source.hpp"
#include "src/ros/inputs/message_log.hpp"
#include "src/ros/support/unknown.hpp"
#include "src/ros/support/worker.hpp"

namespace fiber_proximity_ros {

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

  /// Messages of one input that wait, for their transforms or for those of the other inputs.
  /// Without synchronisation one keeps its turn, and the newest stands behind it.
  std::size_t queue_size() const { return synchronize ? 10 : 2; }
};

/// One source of fibres: reads and checks its messages, has them wait for their transforms and, if
/// inputs are synchronised, for those of the others, and knows how old its fibres are.
///
/// Few messages wait: the first keeps its turn until its transform arrives or `tf_timeout` is over,
/// so that a slow tf delays fibres but never starves them; where there is no more room, the newest
/// one replaces the one before it.
class Input {
 public:
  /// @param worker tries fibres that may cost too much; it must end before the input
  Input(InputOptions options, const InputTiming& timing, Worker& worker);

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
  bool expire(const ros::Time& now, bool is_stranger);

  /// Forgets all fibres, as when time starts again.
  void reset();

  bool is_waiting() const { return !waiting_.empty() || trial_; }

  /// An answer has taken so long [s].
  void doubt(double time) { budget_.doubt(time); }

  /// Whether its fibres are left out as they cost too much; is told once.
  bool takes_leave() { return std::exchange(takes_leave_, false); }

  /// True if there are fibres and they are not stale: these may be used.
  bool is_fresh() const { return has_fibers_ && staleness_ == Staleness::NONE; }

  /// True if no usable message has come for `input_timeout`.
  bool is_silent(const ros::Time& now) const;

  const fiber::FiberAssembly& fibers() const { return current_->fibers; }  ///< in the fixed frame
  const std::vector<std::string>& names() const { return current_->names; }

  /// Of the fibres; the time of their arrival where the message has none.
  const ros::Time& stamp() const { return current_->stamp; }

  const InputOptions& options() const { return options_; }
  fiber_proximity::InputStatistics statistics(const ros::Time& now) const;

  /// Why the fibres are stale; empty if they are not.
  const std::string& stale_reason() const { return stale_reason_; }

  /// What of it is not known now, which makes answers incomplete: the fibres, or some of their
  /// points. Nothing of an input that is not required is missed but points.
  std::optional<Unknown> unknown() const;

 private:
  struct Message {
    std_msgs::Header header;
    ros::Time stamp;  // the time of arrival where the header has none
    ros::Time arrival;
    ros::SteadyTime steady_arrival;
    fiber::FiberAssembly fibers;
    std::vector<std::string> names;
    std::string missing;  // what of its fibres is not known; empty: nothing
  };
  using MessagePtr = std::shared_ptr<Message>;

  /// A message that is tried.
  struct Trial {
    MessagePtr message;
    Prepared<FiberCost> cost;
  };

  /// Why the fibres are stale: no message comes, or those that come match no other input's.
  enum class Staleness { NONE, SILENT, STRANGER };

  /// Messages whose memory can be used again.
  class Spares {
   public:
    MessagePtr take();
    void add(MessagePtr& message) { messages_.push_back(std::move(message)); }

   private:
    std::vector<MessagePtr> messages_;
  };

  std::string absence() const;
  bool store(const ReadMessage& read, FixedFrame& frame);
  void check_stamp(const ros::Time& stamp, const ros::Time& now) const;
  bool place(MessagePtr& message, const FixedFrame& frame);
  std::vector<MessagePtr> place_all(const FixedFrame& frame);
  MessagePtr end_trial();
  void begin_trial(MessagePtr message, const fiber::QueryOptions& answered);
  void leave_out();
  void overtake(MessagePtr& message);

  InputOptions options_;
  InputTiming timing_;
  MessageLog log_;
  SequenceGaps gaps_;
  MissingPointCounts missing_;

  FiberBuffer chains_;                   // what is being read; a member for its memory
  std::vector<Eigen::Vector3d> buffer_;  // the same
  Spares spares_;                        // the same

  InputBudget budget_;
  Worker& worker_;

  std::deque<MessagePtr> waiting_;  // for their transforms
  std::optional<Trial> trial_;      // of the one whose turn it is
  std::deque<MessagePtr> placed_;   // in the fixed frame, to be accepted
  MessagePtr current_ = std::make_shared<Message>();
  bool takes_leave_ = false;
  bool has_fibers_ = false;
  Staleness staleness_ = Staleness::NONE;
  std::string stale_reason_;
  bool repeats_stamp_ = false;
  ros::Time beginning_ = ros::Time::now();  // since when it is waited for

  // Of the last message stored, and of the last one placed; empty if there was none.
  std::optional<ros::Time> last_stamp_;
  std::optional<ros::Time> last_arrival_;
  std::optional<ros::Time> newest_header_stamp_;
  std::optional<ros::Time> newest_arrival_;

  std::string transform_error_;
};

}  // namespace fiber_proximity_ros
