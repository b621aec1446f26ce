#pragma once

#include <ros/time.h>

#include <deque>
#include <functional>
#include <string>

#include "fiber_proximity/InputStatistics.h"
#include "fiber_proximity/ros/refusal_log.hpp"

namespace fiber_proximity_ros {

/// Messages of one topic that change the environment. They are applied in the order in which they
/// came, each as soon as its transforms are known; those that wait for longer are refused.
class WaitingChanges {
 public:
  /// @param timeout [s] of wall time
  WaitingChanges(std::string topic, std::string type, double timeout);

  /// Takes what a message asks for.
  /// @param apply applies all of it, or throws: std::invalid_argument, or TransformUnavailable,
  ///        which may be over later
  void receive(std::function<void()> apply);

  /// Counts and logs a message that is malformed.
  void refuse(const std::string& reason);

  /// @returns true if something was applied
  bool update();

  bool is_waiting() const { return !waiting_.empty(); }
  fiber_proximity::InputStatistics statistics(const ros::Time& now) const;

 private:
  struct Change {
    std::function<void()> apply;
    ros::SteadyTime arrival;
  };

  /// @returns false if the change goes on waiting
  bool apply(const Change& change);

  std::string topic_;
  std::string type_;
  double timeout_;
  std::deque<Change> waiting_;
  RefusalLog refusals_;
  std::uint64_t received_ = 0;
  std::uint64_t applied_ = 0;
  ros::Time last_applied_;
};

}  // namespace fiber_proximity_ros
