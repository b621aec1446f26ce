#pragma once

#include <ros/time.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "src/ros/inputs/input.hpp"
#include "src/ros/inputs/stamp_matcher.hpp"

namespace fiber_proximity_ros {

using Inputs = std::vector<std::unique_ptr<Input>>;

/// Has the fibres of all inputs change together, to those whose stamps belong together. Inputs that
/// have fallen silent, or whose stamps never match, are left out, as they would stop the others.
class Synchronizer {
 public:
  Synchronizer(std::size_t inputs, const InputTiming& timing, const ros::Time& now)
      : matcher_(inputs, timing.synchronize_slop, timing.queue_size()),
        input_timeout_(timing.input_timeout),
        last_match_(now) {}

  /// Notes a message of an input that is in the fixed frame.
  void add(std::size_t input, const ros::Time& stamp) { matcher_.add(input, stamp); }

  /// Has the inputs accept what belongs together.
  /// @returns true if there was anything
  bool accept(const Inputs& inputs, const ros::Time& now);

  /// Whether an input is left out as its stamps never match.
  bool is_unmatched(std::size_t input) const { return matcher_.is_unmatched(input); }

  /// Forgets all messages, as when time starts again.
  void reset(const ros::Time& now);

 private:
  StampMatcher matcher_;
  double input_timeout_;  // [s]
  ros::Time last_match_;  // when a set was found, or none was waited for
};

}  // namespace fiber_proximity_ros
