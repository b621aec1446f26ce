#include "src/ros/detection/budget.hpp"

#include <cmath>
#include <iterator>

namespace fiber_proximity_ros {
namespace {

/// The part of the deadline that answers aim at, as clocks, interruptions and looks at pairs are
/// not exact.
constexpr double aimed_part = 0.95;

/// Where stages that an answer can do without would bring all that cannot be shortened beyond this
/// part of the deadline, they are left out, so that there is time to look at pairs.
constexpr double max_fixed_part = 0.5;

/// By this, so that a stage that is left out is tried again, if it takes twice the time that there
/// is, in one of 350 answers.
constexpr double forgotten_part = 0.002;

bool looks_at_pairs(Stage stage) {
  return stage == Stage::CONTACTS || stage == Stage::MOTION || stage == Stage::ENVIRONMENT ||
         stage == Stage::ENVIRONMENT_MOTION || stage == Stage::PREDICTION;
}

bool is_dispensable(Stage stage) {
  return stage == Stage::MOTION || stage == Stage::ENVIRONMENT_MOTION || stage == Stage::PREDICTION;
}

}  // namespace

void StageCosts::add(double seconds) {
  if (std::exchange(is_guess_, false)) {
    costs_.clear();
    next_ = 0;
  }
  if (costs_.size() < kept) {
    costs_.push_back(seconds);
  } else {
    costs_[next_] = seconds;
  }
  next_ = (next_ + 1) % kept;
}

void StageCosts::forget_a_little() {
  is_guess_ = true;
  for (double& cost : costs_) {
    cost *= 1.0 - forgotten_part;
  }
}

double StageCosts::quantile(std::size_t one_of) const {
  if (costs_.empty()) {
    return 0.0;
  }
  std::vector<double> sorted = costs_;
  const auto at = sorted.end() - 1 - static_cast<std::ptrdiff_t>(sorted.size() / one_of);
  std::nth_element(sorted.begin(), std::max(at, sorted.begin()), sorted.end());
  return *std::max(at, sorted.begin());
}

void Budget::begin(double deadline, Clock clock, const std::vector<Stage>& planned) {
  deadline_ = deadline;
  if (!is_set()) {
    return;
  }
  clock_ = std::move(clock);
  asked_ = 0.0;
  current_ = Stage::COUNT;
  std::vector<Stage> kept;
  std::copy_if(planned.begin(), planned.end(), std::back_inserter(kept),
               [](Stage stage) { return !is_dispensable(stage); });
  const double now = clock_();
  for (const Stage stage : planned) {
    if (is_dispensable(stage)) {
      kept.push_back(stage);
      if (now + reserve(kept) > max_fixed_part * deadline_) {
        kept.pop_back();
        costs_[index(stage)].forget_a_little();
      }
    }
  }
  is_planned_ = {};
  for (const Stage stage : kept) {
    is_planned_[index(stage)] = true;
  }
}

bool Budget::allows(Stage stage) const {
  if (stage == Stage::DRAWING) {
    return !is_set() || clock_() + reserve({stage}) <= aimed_part * deadline_;
  }
  return !is_set() || is_planned_[index(stage)];
}

void Budget::enter(Stage stage) {
  if (!is_set()) {
    return;
  }
  const double now = fixed();
  if (current_ != Stage::COUNT) {
    costs_[index(current_)].add(now - entered_);
  }
  current_ = stage;
  entered_ = now;
}

/// [s] Of the time that is left, for looking at pairs in the current stage; above 0.
double Budget::share() const {
  constexpr double shortest = 1e-9;
  std::vector<Stage> later;
  int shares = 1;
  for (std::size_t stage = index(current_) + 1; stage < stage_count; ++stage) {
    if (is_planned_[stage]) {
      later.push_back(static_cast<Stage>(stage));
      shares += looks_at_pairs(later.back()) ? 1 : 0;
    }
  }
  const double spent = fixed() - entered_;
  const double unspent = std::max(costs_[index(current_)].usual() - spent, 0.0);
  return std::max((aimed_part * deadline_ - clock_() - unspent - reserve(later)) / shares,
                  shortest);
}

/// [s] For all that cannot be shortened in these stages. They hardly ever are all slow together:
/// spreads add up as those of independent numbers.
double Budget::reserve(const std::vector<Stage>& stages) const {
  double usual = 0.0;
  double squares = 0.0;
  for (const Stage stage : stages) {
    const StageCosts& costs = costs_[index(stage)];
    usual += costs.usual();
    squares += costs.spread() * costs.spread();
  }
  return usual + std::sqrt(squares);
}

}  // namespace fiber_proximity_ros
