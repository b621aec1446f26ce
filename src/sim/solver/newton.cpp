#include "src/sim/solver/newton.hpp"

#include <algorithm>
#include <cmath>

#include "src/sim/solver/coupling.hpp"
#include "src/sim/solver/pack_kernels.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

/// Factor for the next Newton step.
double next_scale(double scale, const LineSearch::Island& accepted) {
  constexpr double too_short = 1.6;
  constexpr double max_scale = 16.0;
  const double expected = scale * accepted.expected_share;
  return accepted.share == 1.0 && expected > too_short ? std::min(expected, max_scale) : 1.0;
}

}  // namespace

void NewtonSolver::assign(const Rods& rods, const std::vector<std::vector<std::uint32_t>>& packs,
                          std::uint32_t islands, SolverScratch& scratch) {
  scratch_ = &scratch;
  packs_.resize(packs.size());
  islands_.resize(packs.size());
  offsets_.clear();
  members_.clear();
  std::size_t size = 0;
  const std::size_t unknowns = rods.angles.empty() ? 3 : 4;
  for (std::size_t pack = 0; pack < packs.size(); ++pack) {
    packs_[pack].assign(rods, packs[pack]);
    offsets_.push_back(size);
    for (std::size_t lane = 0; lane < packs[pack].size(); ++lane) {
      const std::uint32_t rod = packs[pack][lane];
      islands_[pack][lane] = scratch.islands[rod];
      scratch.systems[rod] = &packs_[pack].system(lane);
      scratch.packs[rod] = static_cast<std::uint32_t>(pack);
      members_.push_back(rod);
      for (std::uint32_t i = 0; i < rods.node_count(rod); ++i) {
        scratch.places[rods.first(rod) + i] = (size + i * unknowns) * lane_count + lane;
      }
    }
    size += packs_[pack].step_size();
  }
  step_.assign(size, SimdBatch{});
  found_positions_.resize(packs.size());
  for (std::size_t pack = 0; pack < packs.size(); ++pack) {
    found_positions_[pack].reserve(packs_[pack].step_size());
  }
  is_short_.reserve(islands);
  is_lower_.reserve(islands);
  states_before_.reserve(islands);
  found_.reserve(islands);
  states_.assign(islands, IslandState{});
  reports_.assign(islands, IslandReport{});
}

void NewtonSolver::begin(const Rods& rods, const Effects& effects, double step) {
  for_each_pack(packs_.size(), Work::LITTLE,
                [&](std::size_t pack) { packs_[pack].begin(rods, effects, step); });
}

void NewtonSolver::load(const Rods& rods) {
  for_each_pack(packs_.size(), Work::LITTLE, [&](std::size_t pack) { packs_[pack].load(rods); });
}

std::optional<double> NewtonSolver::solve(Rods& rods, const Problem& problem) {
  if (problem.travel_bound != nullptr) {
    bound_.begin(problem.travel_bound, static_cast<std::uint32_t>(states_.size()));
  }
  stuck_objects_.clear();
  if (problem.contacts != nullptr) {
    if (problem.has_moving_obstacles) {
      problem.contacts->begin_motion(scratch_->islands, states_.size());
    }
    problem.contacts->begin(rods, problem.friction, problem.origins, problem.step);
  }
  find_free_islands(problem);
  evaluate_energies(rods, problem);
  find_stored_energies(problem, stored_of_start_);
  if (problem.contacts != nullptr) {
    find_kinetic_energies(rods, kinetic_of_start_);
  }
  if (!predict(rods, problem) || !move_obstacles(rods, problem)) {
    return std::nullopt;
  }
  for (std::uint32_t iteration = 0;; ++iteration) {
    if (iteration > 0) {
      update_friction(rods, problem);
    }
    assemble(rods, problem);
    check_convergence(rods, problem, iteration);
    const bool is_any_active = std::any_of(states_.begin(), states_.end(),
                                           [](const auto& state) { return state.is_active; });
    const bool may_go_on = iteration < problem.options.max_iterations;
    if (!is_any_active || !may_go_on) {
      find_gains(rods, problem);
      if (may_go_on && take_back_gains(rods, problem)) {
        continue;
      }
      break;
    }
    find_newton_step(problem);
    if (!bound_step(rods, problem)) {
      return std::nullopt;
    }
    line_search(rods, problem, LineSearch::max_halvings);
    correct_short_steps(rods, problem);
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const LineSearch::Island& accepted = line_search_.island(i);
      states_[i].scale = next_scale(states_[i].scale, accepted);
      // Where no share lowers the energy, only rounding errors are left.
      states_[i].is_active = states_[i].is_active && !accepted.has_failed;
    }
  }
  const std::vector<Impact> impacts =
      problem.contacts != nullptr ? problem.contacts->find_impacts(rods, problem.is_returning)
                                  : std::vector<Impact>{};
  has_impacts_.assign(states_.size(), false);
  for (const Impact& impact : impacts) {
    const std::uint32_t island = scratch_->islands[impact.points.rod_a];
    has_impacts_[island] = has_impacts_[island] || impact.has_begun;
  }
  for_each_pack(packs_.size(), Work::LITTLE, [&](std::size_t pack) { packs_[pack].finish(rods); });
  if (problem.travel_bound != nullptr && !problem.travel_bound->is_final &&
      !bound_.is_within(rods, members_)) {
    return std::nullopt;
  }
  limit_velocities(rods, problem);
  double gain = 0.0;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    gain += stored_[i] - stored_of_start_[i] - obstacle_work_[i];
  }
  if (!impacts.empty() && problem.has_start_rates) {
    gain -= resolve_impacts(rods, problem, impacts);
  }
  return gain;
}

/// Sums the incremental potential where the rods are, by island.
void NewtonSolver::evaluate_energies(Rods& rods, const Problem& problem) {
  for_each_pack(packs_.size(), Work::MUCH, [&](std::size_t pack) {
    packs_[pack].evaluate_energies(problem.effects);
    if (problem.contacts != nullptr || problem.joints != nullptr) {
      store(packs_[pack].rods(), rods);
    }
  });
  if (problem.contacts != nullptr) {
    problem.contacts->update_distances(rods);
    problem.contacts->evaluate_energies(rods);
  }
  if (problem.joints != nullptr) {
    joint_solver_.evaluate_energies(joint_problem(problem), rods);
  }
  sum_energies(problem);
}

/// Sums the energies that were evaluated last, by island.
void NewtonSolver::sum_energies(const Problem& problem) {
  energies_.assign(states_.size(), EnergySum{});
  for_each_rod([&](std::size_t pack, std::size_t lane, std::uint32_t island) {
    energies_[island].add(packs_[pack].energy(lane));
  });
  if (problem.contacts != nullptr) {
    problem.contacts->add_energies(scratch_->islands, energies_);
  }
  if (problem.joints != nullptr) {
    joint_solver_.add_energies(joint_problem(problem), energies_);
  }
}

/// The first guess: moves the rods to where inertia alone leads, as far as the bound allows, if the
/// energy is lower there.
/// @returns false if a rod needs a wider travel bound
bool NewtonSolver::predict(Rods& rods, const Problem& problem) {
  for (std::size_t pack = 0; pack < packs_.size(); ++pack) {
    packs_[pack].predict(part(pack));
  }
  for (IslandState& state : states_) {
    state.is_active = true;
    state.corrections = 0;
    state.predicted_decrease = 0.0;
  }
  if (!bound_step(rods, problem)) {
    return false;
  }
  take_obstacles_along(rods, problem);
  line_search(rods, problem, 0);
  return true;
}

void NewtonSolver::assemble(Rods& rods, const Problem& problem) {
  if (problem.contacts != nullptr) {
    problem.contacts->find_derivatives(rods);
  }
  for_each_pack(packs_.size(), Work::MUCH, [&](std::size_t pack) {
    packs_[pack].assemble(problem.effects);
    if (problem.contacts != nullptr) {
      add_derivatives(problem.contacts->terms(), rods, scratch_->systems, scratch_->packs,
                      static_cast<std::uint32_t>(pack));
    }
    if (problem.joints == nullptr) {
      packs_[pack].update_residuals();
    }
  });
  if (problem.joints != nullptr) {
    joint_solver_.add_derivatives(joint_problem(problem), rods, scratch_->systems);
    for (PackStep& pack : packs_) {
      pack.update_residuals();
    }
  }
}

/// Makes the step by the bands alone that of the rods with their joints.
void NewtonSolver::add_joints_to_step(const Problem& problem) {
  right_sides_.assign(step_.size(), SimdBatch{});
  for (std::size_t pack = 0; pack < packs_.size(); ++pack) {
    const std::vector<SimdBatch>& gradient = packs_[pack].system().gradient;
    for (std::size_t i = 0; i < gradient.size(); ++i) {
      for (std::size_t lane = 0; lane < packs_[pack].rods().used; ++lane) {
        right_sides_[offsets_[pack] + i][lane] = -gradient[i][lane];
      }
    }
  }
  const JointSolver::Problem joints = joint_problem(problem);
  joint_solver_.factorise(joints, packs_);
  joint_solver_.solve(joints, packs_, right_sides_, step_);
}

void NewtonSolver::find_newton_step(const Problem& problem) {
  for_each_pack(packs_.size(), Work::MUCH,
                [&](std::size_t pack) { packs_[pack].find_newton_step(part(pack)); });
  if (problem.joints != nullptr) {
    add_joints_to_step(problem);
  }
  // Inactive islands do not move, so that their rods need no wider travel bound.
  for_each_rod([&](std::size_t pack, std::size_t lane, std::uint32_t island) {
    if (!states_[island].is_active) {
      for (std::size_t i = 0; i < packs_[pack].step_size(); ++i) {
        part(pack)[i][lane] = 0.0;
      }
    }
  });
  update_directional_derivatives();
  if (problem.contacts != nullptr && has_coupling(problem.contacts->terms())) {
    decreases_.clear();
    for (const IslandState& state : states_) {
      decreases_.push_back(state.predicted_decrease);
    }
    std::optional<JointSolver::Problem> joints;
    if (problem.joints != nullptr) {
      joints.emplace(joint_problem(problem));
    }
    coupling_.solve(
        {packs_, offsets_, islands_, decreases_, problem.contacts->terms(), scratch_->places,
         joints ? &joint_solver_ : nullptr, joints ? &*joints : nullptr},
        step_);
    update_directional_derivatives();
  }
  // Where the matrix is stiffer than the Hessian, steps are too short, each by about the same
  // factor, which the line search of the last step has estimated.
  for_each_rod([&](std::size_t pack, std::size_t lane, std::uint32_t island) {
    const double scale = states_[island].scale;
    for (std::size_t i = 0; scale != 1.0 && i < packs_[pack].step_size(); ++i) {
      part(pack)[i][lane] *= scale;
    }
  });
  for (IslandState& state : states_) {
    state.predicted_decrease *= state.scale;
  }
}

/// The predicted decrease of a whole step is minus the directional derivative along it.
void NewtonSolver::update_directional_derivatives() {
  for (IslandState& state : states_) {
    state.predicted_decrease = 0.0;
  }
  for (std::size_t pack = 0; pack < packs_.size(); ++pack) {
    const std::vector<SimdBatch>& gradient = packs_[pack].system().gradient;
    const std::size_t used = packs_[pack].rods().used;
    const SimdBatch slopes = dot_products({gradient.size(), used}, gradient.data(), part(pack));
    for (std::size_t lane = 0; lane < used; ++lane) {
      states_[islands_[pack][lane]].predicted_decrease -= slopes[lane];
    }
  }
}

/// @returns false if a rod needs a wider travel bound
bool NewtonSolver::bound_step(const Rods& rods, const Problem& problem) {
  trial_shares_.assign(states_.size(), 1.0);
  if (problem.contacts == nullptr) {
    return true;
  }
  using Stride = Eigen::InnerStride<lane_count>;
  const double* const step = step_.data()->lanes.data();
  for (const std::uint32_t rod : members_) {
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      scratch_->displacements[i] =
          Eigen::Map<const Vector3d, 0, Stride>(step + scratch_->places[i]);
    }
  }
  return bound_.bound(rods, scratch_->displacements, members_, scratch_->islands, *problem.contacts,
                      trial_shares_, scratch_->ends);
}

/// Moves the rods of each island along the step to a lower energy, or not at all.
void NewtonSolver::line_search(Rods& rods, const Problem& problem, int halvings) {
  line_search_.begin(states_.size(), halvings);
  for (std::size_t i = 0; i < states_.size(); ++i) {
    line_search_.island(i) = {energies_[i], states_[i].predicted_decrease,
                              states_[i].is_active ? trial_shares_[i] : 0.0, states_[i].is_active,
                              false};
  }
  line_search_.run([&]() -> const std::vector<EnergySum>& {
    evaluate_trial_step(rods, problem);
    return energies_;
  });
  for (std::size_t i = 0; i < states_.size(); ++i) {
    trial_shares_[i] = line_search_.island(i).share;
  }
  if (problem.contacts != nullptr) {
    bound_.advance(trial_shares_);
  }
}

/// Moves the rods to where the shares of the step lead, and evaluates the energies there.
void NewtonSolver::evaluate_trial_step(Rods& rods, const Problem& problem) {
  for_each_pack(packs_.size(), Work::LITTLE, [&](std::size_t pack) {
    SimdBatch shares;
    for (std::size_t lane = 0; lane < packs_[pack].rods().used; ++lane) {
      shares[lane] = line_search_.island(islands_[pack][lane]).share;
    }
    packs_[pack].move(part(pack), shares);
  });
  evaluate_energies(rods, problem);
}

}  // namespace fiber
