#include "src/sim/solver/newton.hpp"

#include <algorithm>
#include <cmath>

#include "src/sim/solver/coupling.hpp"
#include "src/sim/solver/pack_kernels.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

/// An island that has come to rest stays where it is if its residual is within this part of what is
/// asked for; any other has at least one iteration, so that small forces set it in motion.
constexpr double rest_share = 1e-3;

/// By what the step after this one is to be longer than Newton's.
double scale_after(double scale, const LineSearch::Island& found) {
  constexpr double too_short = 1.6;
  constexpr double most = 16.0;
  const double expected = scale * found.expected_share;
  return found.share == 1.0 && expected > too_short ? std::min(expected, most) : 1.0;
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
  searches_.assign(islands, Search{});
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
  if (problem.room != nullptr) {
    bound_.begin(problem.room, static_cast<std::uint32_t>(searches_.size()));
  }
  if (problem.contacts != nullptr) {
    problem.contacts->begin(rods, problem.friction, problem.references, problem.step);
  }
  measure(rods, problem);
  const double stored_before = stored_energy(problem);
  if (!predict(rods, problem)) {
    return std::nullopt;
  }
  for (std::uint32_t iteration = 0;; ++iteration) {
    assemble(rods, problem);
    judge_balance(rods, problem, iteration);
    const bool is_any_active = std::any_of(searches_.begin(), searches_.end(),
                                           [](const Search& search) { return search.is_active; });
    if (!is_any_active || iteration == problem.options.max_iterations) {
      break;
    }
    find_step(problem);
    if (!bound_step(rods, problem)) {
      return std::nullopt;
    }
    // Where no share helps, rounding errors are all that is left.
    search_line(rods, problem, LineSearch::most_halvings);
    for (std::size_t i = 0; i < searches_.size(); ++i) {
      const LineSearch::Island& found = line_.island(i);
      searches_[i].scale = scale_after(searches_[i].scale, found);
      searches_[i].is_active = searches_[i].is_active && !found.has_failed;
    }
  }
  for_each_pack(packs_.size(), Work::LITTLE, [&](std::size_t pack) { packs_[pack].finish(rods); });
  if (problem.room != nullptr && !problem.room->is_last && !bound_.is_within(rods, members_)) {
    return std::nullopt;
  }
  return stored_energy(problem) - stored_before;
}

/// Energies where the rods are, by island.
void NewtonSolver::measure(Rods& rods, const Problem& problem) {
  for_each_pack(packs_.size(), Work::MUCH, [&](std::size_t pack) {
    packs_[pack].measure(problem.effects);
    if (problem.contacts != nullptr) {
      store(packs_[pack].rods(), rods);
    }
  });
  energies_.assign(searches_.size(), EnergySum{});
  for_each_rod([&](std::size_t pack, std::size_t lane, std::uint32_t island) {
    energies_[island].add(packs_[pack].energy(lane));
  });
  if (problem.contacts != nullptr) {
    problem.contacts->measure(rods);
    problem.contacts->add_energies(rods, scratch_->islands, energies_);
  }
}

/// Where the rods are measured.
double NewtonSolver::stored_energy(const Problem& problem) const {
  double stored = problem.contacts != nullptr ? problem.contacts->stored_energy() : 0.0;
  for (const PackStep& pack : packs_) {
    stored += pack.stored_energy();
  }
  return stored;
}

/// Goes where inertia leads, as far as it may, if the energy is lower there.
bool NewtonSolver::predict(Rods& rods, const Problem& problem) {
  for (std::size_t pack = 0; pack < packs_.size(); ++pack) {
    packs_[pack].predict(part(pack));
  }
  for (Search& search : searches_) {
    search.is_active = true;
    search.decrease = 0.0;
  }
  if (!bound_step(rods, problem)) {
    return false;
  }
  search_line(rods, problem, 0);
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
    packs_[pack].measure_residuals();
  });
}

/// Ends the searches of islands whose forces balance. What has learnt from that may unbalance them
/// again.
void NewtonSolver::judge_balance(Rods& rods, const Problem& problem, std::uint32_t iteration) {
  find_residuals();
  const double allowed = (iteration == 0 ? rest_share : 1.0) * problem.options.residual;
  for (std::size_t i = 0; i < searches_.size(); ++i) {
    searches_[i].is_balanced = searches_[i].is_active && reports_[i].residual <= allowed;
  }
  if (learn_multipliers(rods, problem)) {
    for (PackStep& pack : packs_) {
      pack.load_values(problem.effects);
    }
    measure(rods, problem);
    assemble(rods, problem);
    find_residuals();
  }
  for (std::size_t i = 0; i < searches_.size(); ++i) {
    if (searches_[i].is_active) {
      reports_[i].iterations = iteration;
      searches_[i].is_active = !searches_[i].is_balanced;
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

/// Where effects hold conditions, an island is only balanced if these hold.
/// @returns whether anything is to be solved again
bool NewtonSolver::learn_multipliers(Rods& rods, const Problem& problem) {
  for (Search& search : searches_) {
    search.is_learning = search.is_balanced;
  }
  bool has_learnt = false;
  for (const std::unique_ptr<Effect>& effect : problem.effects) {
    if (!effect->has_multipliers()) {
      continue;
    }
    for_each_rod([&](std::size_t pack, std::size_t lane, std::uint32_t island) {
      if (searches_[island].is_learning) {
        store(packs_[pack].rods(), rods);
        if (!effect->update_multipliers(rods, packs_[pack].rods().rods[lane])) {
          searches_[island].is_balanced = false;
          has_learnt = true;
        }
      }
    });
  }
  return has_learnt;
}

void NewtonSolver::find_step(const Problem& problem) {
  for_each_pack(packs_.size(), Work::MUCH,
                [&](std::size_t pack) { packs_[pack].find_step(part(pack)); });
  // What does not search has no step, so that nothing makes room for it.
  for_each_rod([&](std::size_t pack, std::size_t lane, std::uint32_t island) {
    if (!searches_[island].is_active) {
      for (std::size_t i = 0; i < packs_[pack].step_size(); ++i) {
        part(pack)[i][lane] = 0.0;
      }
    }
  });
  weigh_step();
  if (problem.contacts != nullptr && has_coupling(problem.contacts->terms())) {
    decreases_.clear();
    for (const Search& search : searches_) {
      decreases_.push_back(search.decrease);
    }
    coupling_.correct(
        {packs_, offsets_, islands_, decreases_, problem.contacts->terms(), scratch_->places},
        step_);
    weigh_step();
  }
  // Where the Hessian is stiffer than the energy, steps are too short, each by the same factor: the
  // next one is made longer by what the last one has told.
  for_each_rod([&](std::size_t pack, std::size_t lane, std::uint32_t island) {
    const double scale = searches_[island].scale;
    for (std::size_t i = 0; scale != 1.0 && i < packs_[pack].step_size(); ++i) {
      part(pack)[i][lane] *= scale;
    }
  });
  for (Search& search : searches_) {
    search.decrease *= search.scale;
  }
}

/// What the slope of the step promises.
void NewtonSolver::weigh_step() {
  for (Search& search : searches_) {
    search.decrease = 0.0;
  }
  for (std::size_t pack = 0; pack < packs_.size(); ++pack) {
    const std::vector<SimdBatch>& gradient = packs_[pack].system().gradient;
    const std::size_t used = packs_[pack].rods().used;
    const SimdBatch slopes = products({gradient.size(), used}, gradient.data(), part(pack));
    for (std::size_t lane = 0; lane < used; ++lane) {
      searches_[islands_[pack][lane]].decrease -= slopes[lane];
    }
  }
}

/// @returns false if a rod needs more room
bool NewtonSolver::bound_step(const Rods& rods, const Problem& problem) {
  shares_.assign(searches_.size(), 1.0);
  if (problem.contacts == nullptr) {
    return true;
  }
  using Stride = Eigen::InnerStride<lane_count>;
  const double* const step = step_.data()->of.data();
  for (const std::uint32_t rod : members_) {
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      scratch_->displacements[i] =
          Eigen::Map<const Vector3d, 0, Stride>(step + scratch_->places[i]);
    }
  }
  return bound_.bound(rods, scratch_->displacements, members_, scratch_->islands, *problem.contacts,
                      shares_, scratch_->ends);
}

/// Moves rods by shares of the step that bring them lower, if there are any.
void NewtonSolver::search_line(Rods& rods, const Problem& problem, int halvings) {
  line_.begin(searches_.size(), halvings);
  for (std::size_t i = 0; i < searches_.size(); ++i) {
    line_.island(i) = {energies_[i], searches_[i].decrease,
                       searches_[i].is_active ? shares_[i] : 0.0, searches_[i].is_active, false};
  }
  do {
    try_shares(rods, problem);
  } while (line_.judge(energies_));
  bool has_to_return = false;
  for (std::size_t i = 0; i < searches_.size(); ++i) {
    has_to_return |= line_.island(i).has_failed;
  }
  if (line_.refine(energies_)) {
    try_shares(rods, problem);
    has_to_return = line_.settle(energies_);
  }
  if (has_to_return) {
    try_shares(rods, problem);
  }
  for (std::size_t i = 0; i < searches_.size(); ++i) {
    shares_[i] = line_.island(i).share;
  }
  if (problem.contacts != nullptr) {
    bound_.advance(shares_);
  }
}

/// Measures where the shares of the step lead.
void NewtonSolver::try_shares(Rods& rods, const Problem& problem) {
  for_each_pack(packs_.size(), Work::LITTLE, [&](std::size_t pack) {
    SimdBatch shares;
    for (std::size_t lane = 0; lane < packs_[pack].rods().used; ++lane) {
      shares[lane] = line_.island(islands_[pack][lane]).share;
    }
    packs_[pack].move(part(pack), shares);
  });
  measure(rods, problem);
}

}  // namespace fiber
