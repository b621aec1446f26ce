// The part of a solve that brings moving obstacles to where they end it.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "src/sim/solver/newton.hpp"

namespace fiber {

/// Obstacles come along as rods give way: each step of Newton's method is one of both, rods and
/// what is left of the obstacles' way, and the bound on it knows both motions. So nothing passes,
/// and what is pushed moves with what pushes it. The energy may rise on the way, as obstacles do
/// work: what counts is where it ends, from where the rods go on to the minimum of the potential
/// with the obstacles at their ends.
/// @returns false if a rod needs a wider travel bound, or obstacles are stuck
bool NewtonSolver::move_obstacles(Rods& rods, const Problem& problem) {
  constexpr int max_rounds = 400;
  constexpr int patience = 40;     // rounds
  constexpr double little = 1e-3;  // of the way that was left, in so many rounds
  MovedShapes* const moved =
      problem.contacts != nullptr ? problem.contacts->moved_shapes() : nullptr;
  if (moved == nullptr) {
    return true;
  }
  std::vector<double> left(states_.size(), 1.0);  // when patience began
  for (int round = 0;; ++round) {
    bool is_any_moving = false;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      states_[i].is_active = moved->progress(i) < 1.0;
      states_[i].scale = 1.0;
      is_any_moving |= states_[i].is_active;
    }
    if (!is_any_moving) {
      break;
    }
    bool is_any_stuck = round == max_rounds;
    for (std::size_t i = 0; round > 0 && round % patience == 0 && i < states_.size(); ++i) {
      is_any_stuck |= states_[i].is_active && 1.0 - moved->progress(i) > (1.0 - little) * left[i];
      left[i] = 1.0 - moved->progress(i);
    }
    if (is_any_stuck) {
      stuck_progress_ = 1.0;
      for (std::size_t i = 0; i < states_.size(); ++i) {
        if (states_[i].is_active) {
          const std::vector<std::uint32_t> objects = moved->objects_of(i);
          stuck_objects_.insert(stuck_objects_.end(), objects.begin(), objects.end());
          stuck_progress_ = std::min(stuck_progress_, moved->progress(i));
        }
      }
      return false;
    }
    assemble(rods, problem);
    find_newton_step(problem);
    if (!bound_step(rods, problem)) {
      return false;
    }
    move_with_obstacles(rods, problem);
  }
  for (IslandState& state : states_) {
    state.is_active = true;
    state.predicted_decrease = 0.0;
  }
  return true;
}

/// Moves rods and obstacles of islands by their shares of a step, or less where contacts would be
/// closer than they may be.
void NewtonSolver::move_with_obstacles(Rods& rods, const Problem& problem) {
  constexpr int max_halvings = 60;
  MovedShapes& moved = *problem.contacts->moved_shapes();
  std::vector<double> before;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    before.push_back(moved.progress(i));
    trial_shares_[i] = states_[i].is_active ? trial_shares_[i] : 0.0;
  }
  bool is_finite = false;
  for (int halvings = 0; !is_finite; ++halvings) {
    line_search_.begin(states_.size(), 0);
    for (std::size_t i = 0; i < states_.size(); ++i) {
      line_search_.island(i).share = trial_shares_[i];
      if (states_[i].is_active) {
        const double share = trial_shares_[i];
        moved.go_to(i, share == 1.0 ? 1.0 : before[i] + share * (1.0 - before[i]));
      }
    }
    evaluate_trial_step(rods, problem);
    is_finite = true;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      if (!std::isfinite(energies_[i].energy) && trial_shares_[i] > 0.0) {
        trial_shares_[i] = halvings < max_halvings ? 0.5 * trial_shares_[i] : 0.0;
        is_finite = false;
      }
    }
  }
  bound_.advance(trial_shares_);
}

/// The work of moving obstacles in the solve, that of each island for itself as well [J].
double NewtonSolver::obstacle_work(const Rods& rods, const Problem& problem) {
  obstacle_work_.clear();
  if (problem.contacts == nullptr || problem.contacts->moved_shapes() == nullptr) {
    return 0.0;
  }
  obstacle_work_.assign(states_.size(), 0.0);
  problem.contacts->add_obstacle_work(rods, scratch_->islands, obstacle_work_);
  return std::accumulate(obstacle_work_.begin(), obstacle_work_.end(), 0.0);
}

}  // namespace fiber
