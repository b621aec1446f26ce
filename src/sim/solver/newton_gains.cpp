// The part of a solve by which contacts give back no more energy than they have taken.
//
// A converged step of implicit Euler gains none where energies are convex. That of a contact is
// not: its distance is convex, and the energy falls with it. Where the sides of a contact go round
// each other in a step, the force along the normal at its end does more work than the contact gives
// back of its energy.

#include <algorithm>
#include <cmath>

#include "src/sim/solver/newton.hpp"

namespace fiber {

using Eigen::Vector3d;

/// Finds the energy that contacts have given an island where it is, by island [J]; 0 where it is
/// little, or where most of it has come from elsewhere.
void NewtonSolver::find_gains(const Rods& rods, const Problem& problem) {
  constexpr double min_gain = 1e-7;  // of the kinetic energy
  constexpr double main_part = 0.5;  // so much of a gain is of contacts where they make it
  find_stored_energies(problem, stored_);
  find_obstacle_work(rods, problem);
  gains_.assign(states_.size(), 0.0);
  if (problem.contacts == nullptr || !problem.has_start_rates) {
    return;
  }
  find_max_kinetic();
  kinetic_.assign(states_.size(), 0.0);
  for (std::size_t pack = 0; pack < packs_.size(); ++pack) {
    const SimdBatch energies = packs_[pack].kinetic_energies();
    for (std::size_t lane = 0; lane < packs_[pack].rods().used; ++lane) {
      kinetic_[islands_[pack][lane]] += energies[lane];
    }
  }
  bool are_gains = false;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const double gain = kinetic_[i] - max_kinetic_[i];
    gains_[i] = gain > min_gain * kinetic_[i] ? gain : 0.0;
    are_gains |= gains_[i] > 0.0;
  }
  if (!are_gains) {
    return;
  }
  excess_.assign(states_.size(), 0.0);
  problem.contacts->add_excess_work(rods, scratch_->islands, excess_);
  for (std::size_t i = 0; i < states_.size(); ++i) {
    gains_[i] = excess_[i] > main_part * gains_[i] ? std::min(gains_[i], excess_[i]) : 0.0;
  }
}

/// Has the contacts of islands that have gained energy press along their normals in the middle of
/// the way, and the islands go on to the minimum with these.
/// @returns whether there are any such islands
bool NewtonSolver::take_back_gains(const Rods& rods, const Problem& problem) {
  constexpr double max_left = 0.5;  // of what was gained before, while that is mended
  is_gaining_.clear();
  for (std::size_t i = 0; i < states_.size(); ++i) {
    IslandState& state = states_[i];
    is_gaining_.push_back(gains_[i] > 0.0 && state.is_converged &&
                          gains_[i] < max_left * state.gain);
    state.gain = gains_[i];
  }
  if (std::find(is_gaining_.begin(), is_gaining_.end(), true) == is_gaining_.end()) {
    return false;
  }
  midpoint_contacts_.assign(states_.size(), 0);
  problem.contacts->use_midpoint_normals(rods, scratch_->islands, is_gaining_, midpoint_contacts_);
  sum_energies(problem);
  bool is_any_active = false;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (is_gaining_[i]) {
      reports_[i].midpoint_contacts = midpoint_contacts_[i];
      states_[i].is_active = states_[i].has_new_gain = midpoint_contacts_[i] > 0;
      is_any_active |= states_[i].is_active;
    }
  }
  return is_any_active;
}

/// Takes from the velocities of islands what they have gained all the same: in steps so long that
/// rods go round each other, no force along a normal leads to where they are without that. Where
/// nothing holds an island, momentum stays.
void NewtonSolver::limit_velocities(Rods& rods, const Problem& problem) {
  if (std::all_of(gains_.begin(), gains_.end(), [](double gain) { return gain == 0.0; })) {
    return;
  }
  // Friction stores energy as well, if little.
  problem.contacts->add_slip_energies(rods, scratch_->islands, gains_);
  std::vector<double> masses(states_.size(), 0.0);
  std::vector<Vector3d> momenta(states_.size(), Vector3d::Zero());
  for (const std::uint32_t rod : members_) {
    const std::uint32_t island = scratch_->islands[rod];
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod) && !states_[island].is_bound; ++i) {
      masses[island] += rods.masses[i];
      momenta[island] += rods.masses[i] * rods.velocities[i];
    }
  }
  for (const std::uint32_t rod : members_) {
    const std::uint32_t island = scratch_->islands[rod];
    if (gains_[island] == 0.0) {
      continue;
    }
    const double mass = masses[island];
    const Vector3d mean = mass > 0.0 ? Vector3d(momenta[island] / mass) : Vector3d::Zero();
    const double relative = kinetic_[island] - 0.5 * mass * mean.squaredNorm();
    const double factor = std::sqrt(1.0 - gains_[island] / std::max(gains_[island], relative));
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      rods.velocities[i] = mean + factor * (rods.velocities[i] - mean);
      if (!rods.spins.empty()) {
        rods.spins[i] *= factor;
      }
    }
  }
}

}  // namespace fiber
