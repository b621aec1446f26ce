// The second-order correction of Newton steps that the line search cuts short.

#include "src/sim/solver/newton.hpp"

namespace fiber {

/// Edges of a limp rod are far stiffer than anything that resists their turning. A Newton step that
/// turns an edge by an angle a stretches it by a² / 2, so that the energy rises, however good the
/// step is, and the line search allows only small ones (the Maratos effect; Nocedal and Wright
/// 2006, Sect. 15.5). So where a step was cut short, all of it and a few Newton steps more are
/// tried as well, and kept where the energy is lower than what the line search has found.
void NewtonSolver::correct_short_steps(Rods& rods, const Problem& problem) {
  constexpr int corrections = 3;
  if (problem.contacts != nullptr) {
    return;  // the bound on a step is that of a single one
  }
  is_short_.assign(states_.size(), false);
  bool is_any_short = false;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    is_short_[i] = states_[i].is_active && line_search_.island(i).share < 1.0 &&
                   reports_[i].iterations + 1 + corrections <= problem.options.max_iterations;
    is_any_short |= is_short_[i];
  }
  if (!is_any_short) {
    return;
  }
  states_before_ = states_;
  found_ = energies_;
  for (std::size_t pack = 0; pack < packs_.size(); ++pack) {
    found_positions_[pack] = packs_[pack].rods().positions;
    SimdBatch shares;
    for (std::size_t lane = 0; lane < packs_[pack].rods().used; ++lane) {
      const std::uint32_t island = islands_[pack][lane];
      shares[lane] = is_short_[island] ? 1.0 : line_search_.island(island).share;
    }
    packs_[pack].move(part(pack), shares);
  }
  for (std::size_t i = 0; i < states_.size(); ++i) {
    states_[i].is_active = is_short_[i];
    states_[i].scale = 1.0;
  }
  is_lower_.assign(states_.size(), false);
  for (int correction = 0; correction < corrections; ++correction) {
    assemble(rods, problem);
    find_newton_step(problem);
    SimdBatch whole;
    whole.lanes.fill(1.0);
    for (std::size_t pack = 0; pack < packs_.size(); ++pack) {
      packs_[pack].move(part(pack), whole);
    }
    evaluate_energies(rods, problem);
    for (std::size_t i = 0; i < states_.size(); ++i) {
      states_before_[i].corrections += states_[i].is_active ? 1 : 0;
      if (states_[i].is_active && energies_[i].energy < found_[i].energy - found_[i].roundoff()) {
        is_lower_[i] = true;
        states_[i].is_active = false;
      }
    }
  }
  states_ = states_before_;
  for_each_rod([&](std::size_t pack, std::size_t lane, std::uint32_t island) {
    if (!is_lower_[island]) {
      packs_[pack].restore(found_positions_[pack], lane);
    }
  });
  for (PackStep& pack : packs_) {
    pack.measure();
  }
  evaluate_energies(rods, problem);
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (is_lower_[i]) {
      line_search_.accept_whole_step(i);
    }
  }
}

}  // namespace fiber
