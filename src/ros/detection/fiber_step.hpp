#pragma once

#include <ros/time.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/motion.hpp"
#include "src/query/touch_tracker.hpp"
#include "src/ros/inputs/input_set.hpp"

namespace fiber_proximity_ros {

/// The fibres of an answer, and when they were there.
struct FiberState {
  bool has_fibers = false;  ///< false: there are none, or they are not to be kept
  std::shared_ptr<const FiberMessage> message = std::make_shared<const FiberMessage>();
  std::vector<std::optional<ros::Time>> stamps;  ///< by input, of those that are fresh
  ros::Time stamp;                               ///< the newest
  std::vector<double> uncertainties;             ///< [m] by fibre; empty where there are none
};

/// The step from the fibres of one answer to those of the next: what moved meanwhile, and when.
class FiberStep {
 public:
  /// @param longest_motion [s] more time than this between two states is a jump, not a motion
  explicit FiberStep(double longest_motion) : longest_motion_(longest_motion) {}

  /// Takes the fibres of a new answer.
  void advance(FiberState newest);

  /// An answer is given about the same fibres again, which have not moved since.
  void rest();

  /// It is no motion that can be looked at.
  void refuse(const std::string& problem);

  /// It is a motion, and yet this answer does not look at it.
  void pass_over(const std::string& problem);

  /// Whether both states are known and of one topology, and time went on.
  bool is_motion() const { return is_motion_; }

  /// Why the states before and after were kept and yet no motion is looked at; empty otherwise.
  const std::string& problem() const { return problem_; }

  /// How many such steps there were.
  std::uint64_t problem_count() const { return problem_count_; }

  /// Whether the fibres are known and stand still: see rest().
  bool rests() const { return rests_ && after_.has_fibers; }

  /// The motion; at rest, one from where the fibres are to where they are.
  fiber::FiberMotion motion() const {
    return {rests_ ? after_.message->fibers : before_.message->fibers, after_.message->fibers};
  }

  /// [m] By fibre, the larger of before and after; empty where none is uncertain.
  std::vector<double> uncertainties() const;

  /// The time of the motion, from the oldest stamp before to the newest one after among the inputs
  /// that have moved. Without a motion both ends are the newest stamp of all.
  const fiber::TimeBounds& time() const { return time_; }

 private:
  std::string find_motion();
  void set_static();

  double longest_motion_;  // [s]
  FiberState before_;
  FiberState after_;
  fiber::TimeBounds time_;
  bool is_motion_ = false;
  bool rests_ = false;
  std::string problem_;
  std::uint64_t problem_count_ = 0;
};

}  // namespace fiber_proximity_ros
