#include "src/ros/inputs/input_budget.hpp"

#include <ctime>
#include <sstream>
#include <utility>

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "src/ros/support/stopwatch.hpp"

namespace fiber_proximity_ros {
namespace {

// At most, of the dearest kernel (the trial tells how long they really take).
constexpr double seconds_for_pair = 1e-6;

/// The largest part of the time that trials may take.
constexpr double trial_part = 0.05;

/// [s] For so long fibres that have passed a trial are not tried again.
constexpr double shortest_trust = 1.0;

/// Time of the processor that this thread has used [s].
double thread_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

FiberCost cost_of(const fiber::FiberAssembly& fibers, fiber::QueryOptions options,
                  const CostLimits& limits) {
  const Stopwatch stopwatch;
  const double begin = thread_time();
  fiber::EngineOptions one_thread;
  one_thread.threads = 1;
  const auto engine = fiber::make_engine("run_tree", one_thread);
  engine->update(fibers);
  const double update_time = thread_time() - begin;
  options.pair_limit = limits.max_pairs;
  const bool has_deadline = limits.max_time > 0.0;
  const double left = limits.max_time - update_time;  // [s] of the processor
  bool takes_too_long = has_deadline && left <= 0.0;
  bool has_too_many_pairs = false;
  fiber::QueryResult result;
  // A deadline counts the time of other threads, too. Where these took it, there is one more try.
  for (options.deadline = has_deadline ? left : 0.0; !takes_too_long; options.deadline *= 2.0) {
    const double query_begin = thread_time();
    engine->query(options, result);
    if (result.complete) {
      break;
    }
    has_too_many_pairs = result.limit_reached;
    takes_too_long = has_too_many_pairs || thread_time() - query_begin >= left;
  }
  FiberCost cost;
  if (takes_too_long) {
    std::ostringstream problem;
    problem << "its " << fibers.segment_count() << " segments cost too much: by themselves they ";
    if (has_too_many_pairs) {
      problem << "have more than " << options.pair_limit << " pairs within the margin of "
              << options.margin << " m or next to it (max_pairs)";
    } else {
      problem << "take longer than " << limits.max_time << " s (max_time)";
    }
    problem << ". Are they points of a camera? A cloud is one fibre, its points in order";
    cost.problem = problem.str();
  }
  cost.time = stopwatch.seconds();
  return cost;
}

bool InputBudget::is_to_be_tried(const fiber::FiberAssembly& fibers) const {
  const std::size_t count = fibers.segment_count();
  // Fewer segments cannot have so many pairs, or take so long.
  const std::size_t all_pairs = count * count / 2;
  const bool may_be_many = limits_.max_pairs > 0 && all_pairs > std::size_t{limits_.max_pairs};
  const bool may_be_slow = limits_.max_time > 0.0 &&
                           seconds_for_pair * static_cast<double>(all_pairs) > limits_.max_time;
  return (may_be_many || may_be_slow) && count > 2 * passed_segments_;
}

void InputBudget::take(const fiber::FiberAssembly& fibers, const FiberCost& cost) {
  last_trial_ = ros::SteadyTime::now();
  if (cost.problem.empty()) {
    passed_segments_ = fibers.segment_count();
  } else {
    passed_segments_ = 0;
    next_trial_ = last_trial_ + ros::WallDuration(cost.time / trial_part);
    if (problem_.empty()) {
      since_ = ros::Time::now();
    }
  }
  problem_ = cost.problem;
}

void InputBudget::doubt(double time) {
  if (limits_.max_time > 0.0 && time > limits_.max_time &&
      (ros::SteadyTime::now() - last_trial_).toSec() > shortest_trust) {
    passed_segments_ = 0;
  }
}

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
