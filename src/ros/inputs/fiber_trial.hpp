#pragma once

#include <optional>

#include "src/ros/inputs/fiber_message.hpp"
#include "src/ros/inputs/input_budget.hpp"
#include "src/ros/support/worker.hpp"

namespace fiber_proximity_ros {

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
