#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "src/sim/contact/contact_set.hpp"
#include "src/sim/solver/joint_solver.hpp"
#include "src/sim/solver/pack_kernels.hpp"
#include "src/sim/solver/pack_step.hpp"

namespace fiber {

/// How long the work on one pack takes: LITTLE for sums and copies, MUCH for energies and bands.
enum class Work { LITTLE, MUCH };

/// Calls function(pack) for so many packs, in parallel. Packs of little work are taken 16 at a
/// time: one of them is done before another thread has woken up.
template <class Function>
void for_each_pack(std::size_t count, Work work, const Function& function) {
  using Range = tbb::blocked_range<std::size_t>;
  const Range all(0, count, work == Work::MUCH ? 1 : 16);
  const auto run = [&](const Range& range) {
    for (std::size_t pack = range.begin(); pack < range.end(); ++pack) {
      function(pack);
    }
  };
  if (all.is_divisible()) {
    tbb::parallel_for(all, run);
  } else {
    run(all);
  }
}

/// The island of each rod of a pack.
using LaneIslands = std::array<std::uint32_t, lane_count>;

/// Newton's step of rods whose contacts reach beyond the bands of their Hessians, by preconditioned
/// conjugate gradients with the bands' factors as preconditioner M (Nocedal and Wright 2006,
/// Alg. 5.3). Each island has its own iteration. With joints, M is that of JointSolver, which keeps
/// all iterates among the steps that move places as one (Gould, Hribar and Nocedal 2001).
///
/// The Hessian A is M and the coupling by contacts. The product A p with a direction p needs no
/// band: p is a sum of preconditioned residuals, so that M p is the same sum of residuals.
class Coupling {
 public:
  /// The packs of one solve, and how their rods are coupled.
  struct Problem {
    const std::vector<PackStep>& packs;       ///< factorised
    const std::vector<std::size_t>& offsets;  ///< of the packs in the step
    const std::vector<LaneIslands>& islands;  ///< by pack
    const std::vector<double>& decreases;     ///< by island: predicted for the step by the bands
                                              ///< alone [J]; 0 where the island has converged
    const ContactTerms& contacts;
    const std::vector<std::size_t>& places;  ///< of nodes in the step
    JointSolver* joint_solver;               ///< null for none; factorised
    const JointSolver::Problem* joints;
  };

  /// Makes the step by the bands alone Newton's step by the whole Hessian.
  /// @param step of all packs
  void solve(const Problem& problem, std::vector<SimdBatch>& step) {
    constexpr int max_iterations = 200;
    start(problem, step);
    for (int i = 0; i < max_iterations && is_any_solving(problem.decreases); ++i) {
      apply(problem);
      update_solution(problem, step);
      update_direction(problem);
    }
  }

 private:
  /// Conjugate gradients of an island.
  struct CgState {
    double squared_norm = 0.0;      // rᵀ M⁻¹ r of the residual r
    double step_size = 0.0;         // along the direction
    double direction_factor = 0.0;  // of the last direction in the next one
    bool is_solving = true;
  };

  /// Spreads a value of each island over the lanes of a pack.
  template <class Value>
  static SimdBatch by_lane(const PackStep& pack, const LaneIslands& islands, const Value& value) {
    SimdBatch values;
    for (std::size_t lane = 0; lane < pack.rods().used; ++lane) {
      values[lane] = value(islands[lane]);
    }
    return values;
  }

  /// Calls function(pack, first, size) for each pack, whose values start at `first` of all values.
  template <class Function>
  static void for_each_part(const Problem& problem, Work work, const Function& function) {
    for_each_pack(problem.packs.size(), work, [&](std::size_t pack) {
      function(pack, problem.offsets[pack],
               SumSize{problem.packs[pack].step_size(), problem.packs[pack].rods().used});
    });
  }

  /// Adds the packs' partial sums up by island.
  /// @returns valid until called again
  const std::vector<double>& sums(const Problem& problem) {
    sums_.assign(states_.size(), 0.0);
    for (std::size_t pack = 0; pack < problem.packs.size(); ++pack) {
      for (std::size_t lane = 0; lane < problem.packs[pack].rods().used; ++lane) {
        sums_[problem.islands[pack][lane]] += partial_sums_[pack][lane];
      }
    }
    return sums_;
  }

  /// The step by the bands leaves the coupling as residual.
  void start(const Problem& problem, const std::vector<SimdBatch>& step) {
    states_.assign(problem.decreases.size(), CgState{});
    partial_sums_.resize(problem.packs.size());
    for (auto* values :
         {&residual_, &preconditioned_, &direction_, &preconditioner_product_, &hessian_product_}) {
      values->resize(step.size());
    }
    for (std::size_t i = 0; i < step.size(); ++i) {
      for (std::size_t lane = 0; lane < lane_count; ++lane) {
        hessian_product_[i][lane] = -step[i][lane];
      }
      residual_[i] = SimdBatch{};
    }
    add_coupling(problem.contacts, problem.places, hessian_product_.data(), residual_.data());
    for_each_part(problem, Work::MUCH, [&](std::size_t pack, std::size_t first, SumSize size) {
      std::copy_n(&residual_[first], size.count, &direction_[first]);
      solve_band(problem.packs[pack].system(), &direction_[first]);
      std::copy_n(&residual_[first], size.count, &preconditioner_product_[first]);
      partial_sums_[pack] = dot_products(size, &residual_[first], &direction_[first]);
    });
    precondition_joints(problem, direction_);
    const std::vector<double>& norms = sums(problem);
    for (std::size_t i = 0; i < states_.size(); ++i) {
      states_[i].squared_norm = norms[i];
    }
  }

  /// With joints, makes the preconditioned residual by the bands alone that by M.
  void precondition_joints(const Problem& problem, std::vector<SimdBatch>& preconditioned) {
    if (problem.joint_solver == nullptr) {
      return;
    }
    problem.joint_solver->solve(*problem.joints, problem.packs, residual_, preconditioned);
    for_each_part(problem, Work::LITTLE, [&](std::size_t pack, std::size_t first, SumSize size) {
      partial_sums_[pack] = dot_products(size, &residual_[first], &preconditioned[first]);
    });
  }

  /// Whether the residual of any island is above the tolerance.
  bool is_any_solving(const std::vector<double>& decreases) {
    constexpr double tolerance = 1e-3;  // of the norm, relative to the predicted decrease
    bool is_any = false;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const double small = tolerance * tolerance * std::max(0.0, decreases[i]);
      states_[i].is_solving &= states_[i].squared_norm > small;
      is_any |= states_[i].is_solving;
    }
    return is_any;
  }

  /// Applies the Hessian to the direction, and finds the step size along it.
  void apply(const Problem& problem) {
    hessian_product_ = preconditioner_product_;
    add_coupling(problem.contacts, problem.places, direction_.data(), hessian_product_.data());
    for_each_part(problem, Work::LITTLE, [&](std::size_t pack, std::size_t first, SumSize size) {
      partial_sums_[pack] = dot_products(size, &direction_[first], &hessian_product_[first]);
    });
    const std::vector<double>& curvatures = sums(problem);
    for (std::size_t i = 0; i < states_.size(); ++i) {
      CgState& state = states_[i];
      state.is_solving &= curvatures[i] > 0.0 && std::isfinite(curvatures[i]);
      state.step_size = state.is_solving ? state.squared_norm / curvatures[i] : 0.0;
      state.direction_factor = state.is_solving ? 1.0 / state.squared_norm : 0.0;
    }
  }

  void update_solution(const Problem& problem, std::vector<SimdBatch>& step) {
    for_each_part(problem, Work::MUCH, [&](std::size_t pack, std::size_t first, SumSize size) {
      const PackStep& pack_step = problem.packs[pack];
      const auto signed_size = [&](double sign) {
        return by_lane(pack_step, problem.islands[pack],
                       [&](std::uint32_t island) { return sign * states_[island].step_size; });
      };
      add_scaled(size, &step[first], &direction_[first], signed_size(1.0), &step[first]);
      add_scaled(size, &residual_[first], &hessian_product_[first], signed_size(-1.0),
                 &residual_[first]);
      std::copy_n(&residual_[first], size.count, &preconditioned_[first]);
      solve_band(pack_step.system(), &preconditioned_[first]);
      partial_sums_[pack] = dot_products(size, &residual_[first], &preconditioned_[first]);
    });
    precondition_joints(problem, preconditioned_);
    const std::vector<double>& norms = sums(problem);
    for (std::size_t i = 0; i < states_.size(); ++i) {
      states_[i].squared_norm = norms[i];
      states_[i].direction_factor *= norms[i];
    }
  }

  void update_direction(const Problem& problem) {
    for_each_part(problem, Work::LITTLE, [&](std::size_t pack, std::size_t first, SumSize size) {
      const SimdBatch direction_factor =
          by_lane(problem.packs[pack], problem.islands[pack],
                  [&](std::uint32_t island) { return states_[island].direction_factor; });
      add_scaled(size, &preconditioned_[first], &direction_[first], direction_factor,
                 &direction_[first]);
      add_scaled(size, &residual_[first], &preconditioner_product_[first], direction_factor,
                 &preconditioner_product_[first]);
    });
  }

  std::vector<CgState> states_;                    // by island
  std::vector<SimdBatch> partial_sums_;            // by pack
  std::vector<double> sums_;                       // by island
  std::vector<SimdBatch> residual_;                // r
  std::vector<SimdBatch> preconditioned_;          // M⁻¹ r
  std::vector<SimdBatch> direction_;               // p
  std::vector<SimdBatch> preconditioner_product_;  // M p
  std::vector<SimdBatch> hessian_product_;         // A p
};

}  // namespace fiber
