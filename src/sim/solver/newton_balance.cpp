// Whether forces balance, and what effects learn from that.

#include <cstddef>

#include "src/sim/solver/newton.hpp"

namespace fiber {

namespace {

/// An island that has come to rest stays where it is if its residual is within this part of what is
/// asked for; any other has at least one iteration, so that small forces set it in motion.
constexpr double rest_share = 1e-3;

}  // namespace

/// Ends the searches of islands whose forces balance. What has learnt from that may unbalance them
/// again.
void NewtonSolver::judge_balance(Rods& rods, const Problem& problem, std::uint32_t iteration) {
  find_residuals();
  const double allowed = (iteration == 0 ? rest_share : 1.0) * problem.options.residual;
  is_balanced_.resize(searches_.size());
  for (std::size_t i = 0; i < searches_.size(); ++i) {
    is_balanced_[i] = searches_[i].is_active && reports_[i].residual <= allowed;
  }
  if (learn_multipliers(rods, problem)) {
    measure_again(rods, problem);
  }
  for (std::size_t i = 0; i < searches_.size(); ++i) {
    if (searches_[i].is_active) {
      reports_[i].iterations = iteration;
      searches_[i].is_active = !is_balanced_[i];
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
      report.rod = packs_[pack].rod(lane);
      report.node = residual.node;
    }
  });
}

/// Where effects hold conditions, an island is only balanced if these hold.
/// @returns whether anything is to be solved again
bool NewtonSolver::learn_multipliers(Rods& rods, const Problem& problem) {
  for (std::size_t i = 0; i < searches_.size(); ++i) {
    searches_[i].is_learning = is_balanced_[i];
  }
  bool has_learnt = false;
  for (const std::unique_ptr<Effect>& effect : problem.effects) {
    if (!effect->has_multipliers()) {
      continue;
    }
    for_each_rod([&](std::size_t pack, std::size_t lane, std::uint32_t island) {
      if (searches_[island].is_learning) {
        packs_[pack].store(rods);
        if (!effect->update_multipliers(rods, packs_[pack].rod(lane))) {
          is_balanced_[island] = false;
          has_learnt = true;
        }
      }
    });
  }
  return has_learnt;
}

/// Energies and derivatives where the rods are, after something has learnt from them.
void NewtonSolver::measure_again(Rods& rods, const Problem& problem) {
  for (PackStep& pack : packs_) {
    pack.load_values(problem.effects);
  }
  measure(rods, problem);
  for (std::size_t i = 0; i < searches_.size(); ++i) {
    searches_[i].energy = energies_[i];
  }
  assemble(rods, problem);
  find_residuals();
}

}  // namespace fiber
