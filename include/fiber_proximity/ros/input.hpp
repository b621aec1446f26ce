#pragma once

#include <ros/time.h>

#include <string>
#include <vector>

#include "fiber_proximity/InputStatistics.h"
#include "fiber_proximity/ros/chain_set.hpp"
#include "fiber_proximity/ros/fixed_frame.hpp"
#include "fiber_proximity/ros/input_types.hpp"
#include "fiber_proximity/ros/refusal_log.hpp"

namespace fiber_proximity_ros {

/// When an input's messages and fibres expire.
struct InputTiming {
  /// [s] of wall time a message may wait for its transform; longer than tf takes to arrive
  double tf_timeout = 0.1;

  /// [s] of ROS time after which fibres that were not renewed are left out; several periods of any
  /// camera
  double input_timeout = 1.0;
};

/// One source of fibres: reads and checks its messages, has them wait for their transforms, and
/// knows how old its fibres are.
///
/// At most two messages wait: one that keeps its turn until its transform arrives or `tf_timeout`
/// is over, so that a slow tf delays fibres but never starves them, and the newest one behind it.
class Input {
 public:
  Input(InputOptions options, const InputTiming& timing);

  /// Takes the newest message. A malformed one is refused and changes nothing.
  void receive(const ReadMessage& read, FixedFrame& frame);

  /// Brings what waits into the fixed frame where tf has the transform by now.
  /// @returns true if the fibres changed
  bool place_waiting(const FixedFrame& frame);

  /// Marks the fibres stale when they were not renewed for `input_timeout`.
  /// @returns true if they have just become so
  bool expire(const ros::Time& now);

  /// Forgets all fibres, as when time starts again.
  void reset();

  bool is_waiting() const { return waiting_.full || next_.full; }

  /// True if there are fibres and they are not stale: these may be used.
  bool is_fresh() const { return has_fibers_ && !stale_; }

  const fiber::FiberAssembly& fibers() const { return current_.fibers; }  ///< in the fixed frame
  const std::vector<std::string>& names() const { return current_.names; }

  /// Of the fibres; the time of their arrival where the message has none.
  const ros::Time& stamp() const { return current_.stamp; }

  const InputOptions& options() const { return options_; }
  fiber_proximity::InputStatistics statistics(const ros::Time& now) const;

 private:
  struct Message {
    bool full = false;
    std_msgs::Header header;
    ros::Time stamp;
    ros::Time arrival;
    ros::SteadyTime steady_arrival;
    fiber::FiberAssembly fibers;
    std::vector<std::string> names;
  };

  void store(const ReadMessage& read, FixedFrame& frame);
  bool place(Message& message, const FixedFrame& frame);
  void accept(Message& message);
  void overtake(Message& message);
  void name_fibers(Message& message) const;
  std::string label() const;

  InputOptions options_;
  InputTiming timing_;
  RefusalLog refusals_;

  ChainSet chains_;                      // what is being read; a member for its memory
  std::vector<Eigen::Vector3d> buffer_;  // the same
  Message next_;
  Message waiting_;
  Message current_;
  bool has_fibers_ = false;
  bool stale_ = false;
  bool repeats_stamp_ = false;

  std::string transform_error_;
  std::uint64_t received_ = 0;
  std::uint64_t overtaken_ = 0;
};

}  // namespace fiber_proximity_ros
