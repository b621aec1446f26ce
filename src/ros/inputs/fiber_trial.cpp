#include "src/ros/inputs/fiber_trial.hpp"

#include <utility>

namespace fiber_proximity_ros {

void FiberTrial::begin(FiberMessagePtr message, const fiber::QueryOptions& answered) {
  auto find_cost = [message, answered, limits = budget_.limits()] {
    return cost_of(message->fibers, answered, limits);
  };
  running_.emplace(
      Running{std::move(message), Prepared<FiberCost>(std::move(find_cost), &worker_)});
}

FiberMessagePtr FiberTrial::end() {
  Running trial = std::move(*std::exchange(running_, std::nullopt));
  budget_.take(trial.message->fibers, trial.cost.get());
  return budget_.problem().empty() ? std::move(trial.message) : nullptr;
}

}  // namespace fiber_proximity_ros
