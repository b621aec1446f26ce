// The part of a solve that gives impacts their restitution, see Impact.

#include <algorithm>
#include <cmath>

#include "src/sim/solver/newton.hpp"

namespace fiber {

using Eigen::Vector3d;

/// Calls function(island, inertia, velocity, displacement) for the unknowns of the rods; inertias
/// and velocities are those of angles where displacements are angles.
template <class Function>
void NewtonSolver::for_each_unknown(Rods& rods, const Function& function) const {
  const double* const step = step_.data()->lanes.data();
  for (const std::uint32_t rod : members_) {
    const std::uint32_t island = scratch_->islands[rod];
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      const double* const displacement = step + scratch_->places[i];
      for (std::uint32_t k = 0; k < 3; ++k) {
        function(island, rods.masses[i], rods.velocities[i][k], displacement[k * lane_count]);
      }
      if (!rods.spins.empty()) {
        const double inertia = rods.sections[rod].inertia_per_length * rods.rest_lengths[i];
        function(island, inertia, rods.spins[i], displacement[3 * lane_count]);
      }
    }
  }
}

/// Kinetic energy of the rods at their velocities, by island [J].
std::vector<double> NewtonSolver::kinetic_energies(Rods& rods) const {
  std::vector<double> energies(states_.size(), 0.0);
  for_each_unknown(rods, [&](std::uint32_t island, double inertia, double velocity, double) {
    energies[island] += 0.5 * inertia * velocity * velocity;
  });
  return energies;
}

/// Finds the change of velocities by Newton's method: the equations are linear but for which
/// impacts press and which slide, and settle in a few iterations.
/// @param max_kinetic energy afterwards, by island [J]
void NewtonSolver::resolve_impacts(Rods& rods, const Problem& problem, std::vector<Impact> impacts,
                                   const std::vector<double>& max_kinetic) {
  constexpr int max_iterations = 30;
  constexpr double max_change = 1e-3;
  const double stick_length =
      problem.friction != nullptr ? problem.friction->stick_length(problem.step) : 0.0;
  for (IslandState& state : states_) {
    state.is_active = false;
    state.scale = 1.0;
  }
  for (Impact& impact : impacts) {
    states_[scratch_->islands[impact.points.rod_a]].is_active = true;
    impact.begin(rods, problem.step);
  }
  for (const std::uint32_t rod : members_) {
    std::fill(scratch_->displacements.begin() + rods.first(rod),
              scratch_->displacements.begin() + rods.end(rod), Vector3d::Zero());
  }
  double change = 1.0;
  for (int i = 0; i < max_iterations && change > max_change; ++i) {
    problem.contacts->find_impact_derivatives(rods, impacts, scratch_->displacements);
    for_each_pack(packs_.size(), Work::MUCH, [&](std::size_t pack) {
      packs_[pack].assemble(problem.effects);
      packs_[pack].clear_gradient();
      add_derivatives(problem.contacts->terms(), rods, scratch_->systems, scratch_->packs,
                      static_cast<std::uint32_t>(pack));
    });
    find_newton_step(problem);
    find_displacements(rods);
    change = 0.0;
    for (Impact& impact : impacts) {
      change = std::max(
          change, impact.update_forces(scratch_->displacements, problem.friction, stick_length));
    }
  }
  change_velocities(rods, problem.step, max_kinetic, impacts);
  problem.contacts->keep_impacts(std::move(impacts));
}

/// Changes the velocities of islands by their displacements, or by the largest part of that which
/// their energy allows.
void NewtonSolver::change_velocities(Rods& rods, double step,
                                     const std::vector<double>& max_kinetic,
                                     std::vector<Impact>& impacts) {
  // Energy by the share y of the change: energies + y linear + y² square.
  const std::vector<double> energies = kinetic_energies(rods);
  std::vector<double> linear(states_.size(), 0.0);
  std::vector<double> square(states_.size(), 0.0);
  for_each_unknown(rods,
                   [&](std::uint32_t i, double inertia, double velocity, double displacement) {
                     const double change = displacement / step;
                     linear[i] += inertia * velocity * change;
                     square[i] += 0.5 * inertia * change * change;
                   });
  std::vector<double> shares(states_.size(), 0.0);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const double allowed = std::max(0.0, max_kinetic[i] - energies[i]);
    if (!states_[i].is_active || linear[i] + square[i] <= allowed) {
      shares[i] = states_[i].is_active ? 1.0 : 0.0;
    } else {
      const double root = std::sqrt(linear[i] * linear[i] + 4.0 * square[i] * allowed);
      shares[i] = (root - linear[i]) / (2.0 * square[i]);
    }
  }
  for_each_unknown(rods, [&](std::uint32_t i, double, double& velocity, double displacement) {
    velocity += shares[i] * displacement / step;
  });
  for (Impact& impact : impacts) {
    const double share = shares[scratch_->islands[impact.points.rod_a]];
    impact.pressure *= share;
    impact.friction *= share;
  }
}

}  // namespace fiber
