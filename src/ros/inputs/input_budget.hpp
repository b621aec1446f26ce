#pragma once

#include <ros/time.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/options.hpp"
#include "src/ros/inputs/fiber_message.hpp"
#include "src/ros/support/worker.hpp"

namespace fiber_proximity_ros {

/// Limits of what the fibres of one input may cost by themselves. The defaults are in
/// cfg/interface.yaml.
struct CostLimits {
  std::uint32_t max_pairs{};  ///< of segments to examine; 0: any number
  double max_time{};          ///< [s] of one processor; 0: any
};

/// The cost of fibres by themselves.
struct FiberCost {
  std::string problem;  ///< why they cost too much; empty if they do not
  double time = 0.0;    ///< [s] that it took to find out
};

/// Asks about the fibres alone, on one thread and in memory that is gone then.
/// @param options of the node's answers
FiberCost cost_of(const fiber::FiberAssembly& fibers, fiber::QueryOptions options,
                  const CostLimits& limits);

/// Keeps one input from delaying the others. Fibres that are many are tried by themselves before
/// they join the others' for the first time, when they have become twice as many, and when answers
/// have come to take long. An input whose fibres cost too much is left out, and its messages are
/// not even read, but for one to try again with, so rarely that it takes a small part of the time.
class InputBudget {
 public:
  explicit InputBudget(const CostLimits& limits) : limits_(limits) {}

  const CostLimits& limits() const { return limits_; }

  /// Whether fibres are to be tried before they join the others.
  bool is_to_be_tried(const fiber::FiberAssembly& fibers) const;

  /// Takes the result of a trial.
  void take(const fiber::FiberAssembly& fibers, const FiberCost& cost);

  /// An answer has taken so long [s]: fibres that have passed may cost more by now.
  void doubt(double time);

  /// Why the last fibres that were tried cost too much; empty if they did not.
  const std::string& problem() const { return problem_; }
  ros::Time since() const { return since_; }

  /// Whether messages are not to be read for now.
  bool is_closed() const { return !problem_.empty() && ros::SteadyTime::now() < next_trial_; }

 private:
  CostLimits limits_;
  std::size_t passed_segments_ = 0;
  ros::SteadyTime last_trial_;
  ros::SteadyTime next_trial_;
  std::string problem_;
  ros::Time since_;
};

/// Tries the fibres of one input by themselves, in another thread, before they join the others'.
class FiberTrial {
 public:
  /// @param worker must end before this
  FiberTrial(const CostLimits& limits, Worker& worker) : budget_(limits), worker_(worker) {}

  InputBudget& budget() { return budget_; }
  const InputBudget& budget() const { return budget_; }

  bool is_running() const { return running_.has_value(); }
  bool is_ready() const { return running_ && running_->cost.is_ready(); }

  /// @param answered what the node asks about fibres
  void begin(FiberMessagePtr message, const fiber::QueryOptions& answered);

  /// Takes the result, which must be ready.
  /// @returns the message that was tried, or null if it costs too much
  FiberMessagePtr end();

  void cancel() { running_.reset(); }

 private:
  struct Running {
    FiberMessagePtr message;
    Prepared<FiberCost> cost;
  };

  InputBudget budget_;
  Worker& worker_;
  std::optional<Running> running_;
};

}  // namespace fiber_proximity_ros
