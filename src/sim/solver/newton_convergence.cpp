// The part of a solve that tells whether it has converged: its residuals, and what changes the
// problem on the way there, multipliers and the normal forces of friction.

#include <algorithm>
#include <cmath>

#include "src/sim/solver/newton.hpp"

namespace fiber {

namespace {

/// Before the first iteration, an island has converged only if its residual is within this part of
/// the tolerance: all others have at least one iteration, so that small forces set them in motion.
constexpr double rest_tolerance = 1e-3;

/// With friction, whose normal forces follow from iteration to iteration, the residual falls by
/// about the same factor in each: where an iteration ends just within the tolerance, all contacts
/// of a rod that slides would err to the same side.
constexpr double friction_tolerance = 0.3;

/// Nothing takes from rods that fly freely what steps leave over: it adds up, as momentum that they
/// turn with. Newton's method has so much less of it after an iteration more, where it converges
/// as it should; where it does not, that is not waited for.
constexpr double free_tolerance = 0.01;
constexpr double slow_convergence = 0.2;  // of the residual before

}  // namespace

void NewtonSolver::find_free_islands(const Problem& problem) {
  const auto touches = [this](std::uint32_t rod) {
    states_[scratch_->islands[rod]].is_free = false;
  };
  const auto binds = [this](std::uint32_t rod) {
    IslandState& state = states_[scratch_->islands[rod]];
    state.is_free = false;
    state.is_bound = true;
  };
  if (problem.contacts != nullptr) {
    problem.contacts->for_each_rod(touches);
    for (const ObstacleContact& contact : problem.contacts->obstacle_contacts) {
      binds(contact.rod);
    }
  }
  for (const std::uint32_t rod : members_) {
    if (std::any_of(problem.effects.begin(), problem.effects.end(),
                    [rod](const auto& effect) { return effect->holds(rod); })) {
      binds(rod);
    }
  }
}

/// Deactivates islands whose residual is within the tolerance, with friction by the forces of now.
/// Effects with multipliers update them first, which may raise the residual again.
void NewtonSolver::check_convergence(Rods& rods, const Problem& problem, std::uint32_t iteration) {
  find_residuals();
  const double allowed = (iteration == 0                ? rest_tolerance
                          : problem.friction != nullptr ? friction_tolerance
                                                        : 1.0) *
                         problem.options.residual;
  const auto is_near = [&](std::size_t i) {
    // A residual by a part of the way to the friction of now has that part of its change, less what
    // is left of Newton's iteration, which may be half of it.
    const double share = states_[i].friction_share;
    const bool is_exact = iteration > 0 && states_[i].is_free &&
                          reports_[i].residual < slow_convergence * states_[i].residual_before;
    const double part = share < 1.0 ? 0.5 * share : is_exact ? free_tolerance : 1.0;
    return states_[i].is_active && !states_[i].has_new_gain &&
           reports_[i].residual <= part * allowed;
  };
  bool has_friction_of_before = false;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    has_friction_of_before |=
        problem.friction != nullptr && is_near(i) && !states_[i].has_friction_of_now;
  }
  if (has_friction_of_before) {
    update_friction(rods, problem);
    assemble(rods, problem);
    find_residuals();
  }
  for (std::size_t i = 0; i < states_.size(); ++i) {
    states_[i].is_converged = is_near(i);
    states_[i].residual_before = reports_[i].residual;
    states_[i].has_new_gain = false;
  }
  if (update_multipliers(rods, problem)) {
    for (PackStep& pack : packs_) {
      pack.load_values(problem.effects);
    }
    evaluate_energies(rods, problem);
    assemble(rods, problem);
    find_residuals();
  }
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (states_[i].is_active) {
      reports_[i].iterations = iteration + states_[i].corrections;
      states_[i].is_active =
          !states_[i].is_converged && reports_[i].iterations < problem.options.max_iterations;
    }
  }
}

void NewtonSolver::find_residuals() {
  for (IslandReport& report : reports_) {
    report.residual = -1.0;
  }
  for_each_rod([&](std::size_t pack, std::size_t lane, std::uint32_t island) {
    const PackStep::Residual residual = packs_[pack].residual(lane);
    IslandReport& report = reports_[island];
    if (!(residual.speed <= report.residual)) {
      report.residual = residual.speed;
      report.rod = packs_[pack].rods().rods[lane];
      report.node = residual.node;
    }
  });
}

/// Updates the Lagrange multipliers of converged islands: one whose constraints do not hold yet has
/// not converged.
/// @returns whether there are any
bool NewtonSolver::update_multipliers(Rods& rods, const Problem& problem) {
  for (IslandState& state : states_) {
    state.was_converged = state.is_converged;
  }
  bool is_any_violated = false;
  for (const auto& effect : problem.effects) {
    if (!effect->has_multipliers()) {
      continue;
    }
    for_each_rod([&](std::size_t pack, std::size_t lane, std::uint32_t island) {
      if (states_[island].was_converged) {
        store(packs_[pack].rods(), rods);
        if (!effect->update_multipliers(rods, packs_[pack].rods().rods[lane])) {
          states_[island].is_converged = false;
          is_any_violated = true;
        }
      }
    });
  }
  return is_any_violated;
}

/// Makes the friction of islands that are near convergence that of the normal forces where they
/// are. A step that ends with friction by the forces of the step before has none in a contact that
/// begins, and any in an impact (Larionov et al. 2023).
///
/// That is an iteration to a fixed point, which diverges where friction raises the normal forces by
/// which it goes by more than they have been raised. Its energy changes by turns up and down then,
/// and from by how much it follows how far to go (Aitken's relaxation; Irons and Tuck 1969).
void NewtonSolver::update_friction(const Rods& rods, const Problem& problem) {
  constexpr double near_convergence = 1000.0;  // times the residual that is allowed
  constexpr double slow = 0.9;  // so much of the change before makes the iteration hardly converge
  constexpr double min_share = 0.2;
  if (problem.friction == nullptr) {
    return;
  }
  friction_shares_.clear();
  for (std::size_t i = 0; i < states_.size(); ++i) {
    IslandState& state = states_[i];
    state.has_friction_of_now =
        state.is_active && reports_[i].residual <= near_convergence * problem.options.residual;
    friction_shares_.push_back(state.has_friction_of_now ? state.friction_share : 0.0);
  }
  energies_before_ = energies_;
  problem.contacts->update_friction(rods, scratch_->islands, friction_shares_);
  sum_energies(problem);
  for (std::size_t i = 0; i < states_.size(); ++i) {
    IslandState& state = states_[i];
    const double share = friction_shares_[i];
    if (share == 0.0) {
      continue;
    }
    const double change = (energies_[i].energy - energies_before_[i].energy) / share;
    const double ratio = state.friction_change != 0.0 ? change / state.friction_change : 0.0;
    if (std::abs(change) <= energies_[i].roundoff()) {
      state.friction_share = 1.0;
    } else if (share < 1.0 || ratio < -slow) {
      state.friction_share = 1.0 - ratio > share ? std::max(min_share, share / (1.0 - ratio)) : 1.0;
    }
    state.friction_change = change;
  }
}

}  // namespace fiber
