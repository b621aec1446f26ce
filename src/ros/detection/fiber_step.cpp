#include "src/ros/detection/fiber_step.hpp"

#include <algorithm>
#include <sstream>
#include <utility>

#include "src/ros/support/stamps.hpp"

namespace fiber_proximity_ros {
namespace {

std::string extent_of(const fiber::FiberAssembly& fibers) {
  return std::to_string(fibers.fiber_count()) + " of " + std::to_string(fibers.point_count()) +
         " points";
}

}  // namespace

void FiberStep::advance(FiberState newest) {
  before_ = std::exchange(after_, std::move(newest));
  rest();
  rests_ = false;
  if (before_.has_fibers && after_.has_fibers) {
    is_motion_ = true;
    if (const std::string problem = find_motion(); !problem.empty()) {
      refuse(problem);
    }
  }
}

std::vector<double> FiberStep::uncertainties() const {
  std::vector<double> most = after_.uncertainties;
  const std::vector<double>& before = before_.uncertainties;
  if (!rests_ && before.size() > most.size()) {
    most.resize(before.size(), 0.0);
  }
  for (std::size_t fiber = 0; !rests_ && fiber < before.size(); ++fiber) {
    most[fiber] = std::max(most[fiber], before[fiber]);
  }
  return most;
}

void FiberStep::rest() {
  is_motion_ = false;
  rests_ = true;
  problem_.clear();
  set_static();
}

void FiberStep::refuse(const std::string& problem) {
  pass_over(problem);
  is_motion_ = false;
  set_static();
}

void FiberStep::pass_over(const std::string& problem) {
  problem_ = problem;
  ++problem_count_;
}

void FiberStep::set_static() {
  const std::chrono::nanoseconds stamp = to_time(after_.stamp);
  time_ = {stamp, stamp};
}

/// Finds when what happened.
/// @returns why this is no motion; empty if it is
std::string FiberStep::find_motion() {
  std::ostringstream problem;
  const fiber::FiberAssembly& before = before_.message->fibers;
  const fiber::FiberAssembly& after = after_.message->fibers;
  if (before_.message->names != after_.message->names || !before.has_topology_of(after)) {
    problem << "the fibres are no longer the same: " << extent_of(before) << " before, "
            << extent_of(after) << " now";
    return problem.str();
  }
  auto begin = ros::Time(ros::TIME_MAX);
  ros::Time end;
  for (std::size_t i = 0; i < after_.stamps.size(); ++i) {
    // One that was not there before has no fibres: with any, they would be others.
    if (before_.stamps[i] && after_.stamps[i] && after_.stamps[i] != before_.stamps[i]) {
      begin = std::min(begin, *before_.stamps[i]);
      end = std::max(end, *after_.stamps[i]);
    }
  }
  if (end <= begin) {
    problem << "their stamps do not rise";
  } else if (const double seconds = (end - begin).toSec(); seconds > longest_motion_) {
    problem << "their stamps jump by " << seconds << " s, a motion may take " << longest_motion_
            << " s (input_timeout)";
  } else {
    time_ = {to_time(begin), to_time(end)};
  }
  return problem.str();
}

}  // namespace fiber_proximity_ros
