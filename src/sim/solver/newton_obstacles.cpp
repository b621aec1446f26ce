// The part of a solve that brings moving obstacles to where they end it.

#include <algorithm>
#include <cmath>

#include "src/sim/solver/newton.hpp"

namespace fiber {

/// In the first guess obstacles go all of their way with the rods, if the bound allows it for both
/// and the energy is lower there. So what lies on an obstacle that moves on as it did, and moves
/// with it, begins where it presses as it did.
void NewtonSolver::take_obstacles_along(Rods& rods, const Problem& problem) {
  MovedShapes* const moved =
      problem.contacts != nullptr ? problem.contacts->moved_shapes() : nullptr;
  if (moved == nullptr) {
    return;
  }
  line_search_.begin(states_.size(), 0);
  std::vector<bool>& goes = is_short_;
  goes.assign(states_.size(), false);
  for (std::size_t i = 0; i < states_.size(); ++i) {
    goes[i] = moved->progress(i) < 1.0 && trial_shares_[i] == 1.0;
    line_search_.island(i).share = goes[i] ? 1.0 : 0.0;
    if (goes[i]) {
      moved->go_to(i, 1.0);
    }
  }
  if (std::find(goes.begin(), goes.end(), true) == goes.end()) {
    return;
  }
  energies_before_ = energies_;
  evaluate_trial_step(rods, problem);
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (goes[i] && !(energies_[i].energy <= energies_before_[i].energy)) {
      moved->go_to(i, 0.0);
    }
  }
  energies_ = energies_before_;
}

/// Obstacles come along as rods give way: each step of Newton's method is one of both, rods and
/// what is left of the obstacles' way, and the bound on it knows both motions. So nothing passes,
/// and what is pushed moves with what pushes it.
///
/// As obstacles do work, energy rises on the way. What must fall is its sum with K (1 − p)², by the
/// progress p: what drives the obstacles. K is at least what brings the rods to their speed, and as
/// much as the step in hand is to need. It pays for nothing where contacts resist by more than
/// obstacles may press with: where rods cannot give way at that, obstacles are stuck. Near that
/// they wait for some rounds, in which rods alone give way. From where this ends the rods go on to
/// the minimum of the potential with the obstacles at their ends.
/// @returns false if a rod needs a wider travel bound, or obstacles are stuck
bool NewtonSolver::move_obstacles(Rods& rods, const Problem& problem) {
  constexpr int max_rounds = 1000;
  constexpr int patience = 50;     // rounds
  constexpr double little = 0.01;  // of the way that was left, in so many rounds
  constexpr double much = 0.5;     // of what obstacles may press with
  constexpr int max_waiting = 5;   // rounds
  MovedShapes* const moved =
      problem.contacts != nullptr ? problem.contacts->moved_shapes() : nullptr;
  if (moved == nullptr) {
    return true;
  }
  begin_drives(rods, problem);
  std::vector<double>& left = ways_left_;  // when patience began
  left.assign(states_.size(), 1.0);
  resistances_.assign(states_.size(), ContactSet::Resistance{});
  rounds_waited_.assign(states_.size(), 0);
  for (int round = 0;; ++round) {
    bool is_any_moving = false;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      states_[i].is_active = moved->progress(i) < 1.0;
      states_[i].scale = 1.0;
      is_any_moving |= states_[i].is_active;
      const bool presses = resistances_[i].now > much * resistances_[i].most;
      rounds_waited_[i] = presses && rounds_waited_[i] < max_waiting ? rounds_waited_[i] + 1 : 0;
      moved->wait(i, rounds_waited_[i] > 0);
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
      keep_stuck(*moved);
      return false;
    }
    assemble(rods, problem);
    find_newton_step(problem);
    if (!bound_step(rods, problem)) {
      return false;
    }
    raise_drives(rods, problem);
    if (!move_with_obstacles(rods, problem)) {
      keep_stuck(*moved);
      return false;
    }
  }
  for (IslandState& state : states_) {
    state.is_active = true;
    state.predicted_decrease = 0.0;
  }
  return true;
}

/// Finds the energy that brings the rods of each island to the speed of the fastest obstacle that
/// they may reach.
void NewtonSolver::begin_drives(const Rods& rods, const Problem& problem) {
  std::vector<double>& ways = ways_left_;
  ways.assign(states_.size(), 0.0);
  problem.contacts->add_longest_ways(rods, scratch_->islands, ways);
  drives_.assign(states_.size(), 0.0);
  for (const std::uint32_t rod : members_) {
    const std::uint32_t island = scratch_->islands[rod];
    const double speed = ways[island] / problem.step;
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      drives_[island] += 0.5 * rods.masses[i] * speed * speed;
    }
  }
}

/// Raises them to twice what the whole step in hand is to cost, by the quadratic model of the
/// energy. With the way d that is left to the obstacles, the contacts' Hessian C by it, and
/// Newton's step s by the Hessian H and the gradient g − C d, that is
///   g·s + e + ½ (s·H s − 2 s·C d + d·C d),
/// and H s = C d − g. The predicted decrease is −(g − C d)·s. Where the weights of contacts change,
/// H is not quite the Hessian, and the quadratic part may come out below 0; then the linear part
/// alone tells, so that the first of the way can be paid for.
void NewtonSolver::raise_drives(const Rods& rods, const Problem& problem) {
  motion_energies_.assign(states_.size(), ContactSet::MotionEnergy{});
  problem.contacts->add_motion_energies(rods, scratch_->displacements, scratch_->islands,
                                        motion_energies_);
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (states_[i].is_active) {
      const ContactSet::MotionEnergy& motion = motion_energies_[i];
      const double decrease = states_[i].predicted_decrease;
      const double linear = motion.mixed - decrease + motion.slope;
      const double quadratic = std::max(0.0, 0.5 * (decrease - 2.0 * motion.mixed + motion.square));
      const double left = 1.0 - problem.contacts->moved_shapes()->progress(i);
      drives_[i] = std::max(drives_[i], 2.0 * (linear + quadratic) / (left * left));
    }
  }
}

void NewtonSolver::keep_stuck(const MovedShapes& moved) {
  stuck_progress_ = 1.0;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (states_[i].is_active) {
      const std::vector<std::uint32_t> objects = moved.objects_of(i);
      stuck_objects_.insert(stuck_objects_.end(), objects.begin(), objects.end());
      stuck_progress_ = std::min(stuck_progress_, moved.progress(i));
    }
  }
}

/// Moves rods and obstacles of islands by their shares of a step, or as much less as what must fall
/// rises, or obstacles would press too deep.
/// @returns false if there is none by which an island can move
bool NewtonSolver::move_with_obstacles(Rods& rods, const Problem& problem) {
  constexpr int max_halvings = 60;
  MovedShapes& moved = *problem.contacts->moved_shapes();
  energies_before_ = energies_;
  std::vector<double>& before = progress_before_;
  before.clear();
  for (std::size_t i = 0; i < states_.size(); ++i) {
    before.push_back(moved.progress(i));
    trial_shares_[i] = states_[i].is_active ? trial_shares_[i] : 0.0;
  }
  bool has_risen = true;
  bool can_move = true;
  for (int halvings = 0; has_risen; ++halvings) {
    line_search_.begin(states_.size(), 0);
    for (std::size_t i = 0; i < states_.size(); ++i) {
      line_search_.island(i).share = trial_shares_[i];
      if (states_[i].is_active) {
        const double share = trial_shares_[i];
        const bool waits = rounds_waited_[i] > 0;
        const double way = waits ? 0.0 : share * (1.0 - before[i]);
        moved.go_to(i, share == 1.0 && !waits ? 1.0 : before[i] + way);
      }
    }
    evaluate_trial_step(rods, problem);
    resistances_.assign(states_.size(), ContactSet::Resistance{});
    problem.contacts->add_resistances(rods, scratch_->islands, resistances_);
    has_risen = false;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const double left = 1.0 - before[i];
      const double left_now = 1.0 - moved.progress(i);
      const bool may_press = resistances_[i].now <= resistances_[i].most;
      const double driven = may_press ? drives_[i] * (left * left - left_now * left_now) : 0.0;
      const bool is_lower = energies_[i].energy <=
                            energies_before_[i].energy + driven + energies_before_[i].roundoff();
      if (trial_shares_[i] > 0.0 && !is_lower) {
        trial_shares_[i] = halvings < max_halvings ? 0.5 * trial_shares_[i] : 0.0;
        can_move &= trial_shares_[i] > 0.0 || rounds_waited_[i] > 0;
        has_risen = true;
      }
    }
  }
  bound_.advance(trial_shares_);
  return can_move;
}

/// Finds the work of moving obstacles in the solve, by island [J].
void NewtonSolver::find_obstacle_work(const Rods& rods, const Problem& problem) {
  obstacle_work_.assign(states_.size(), 0.0);
  if (problem.contacts != nullptr && problem.contacts->moved_shapes() != nullptr) {
    problem.contacts->add_obstacle_work(rods, scratch_->islands, obstacle_work_);
  }
}

}  // namespace fiber
