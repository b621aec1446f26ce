#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "src/sim/contact/contact_set.hpp"
#include "src/sim/solver/pack_kernels.hpp"
#include "src/sim/solver/pack_step.hpp"

namespace fiber {

/// What is to be done for a pack: sums and copies, or what takes as long as its energy or its band.
enum class Work { LITTLE, MUCH };

/// Calls function(pack) for so many packs; in parallel, but little work only if there is more of
/// it: one pack is done before another thread has heard of it.
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

/// To which island each rod of a pack belongs.
using LaneIslands = std::array<std::uint32_t, lane_count>;

/// Newton's step of rods whose contacts reach beyond the bands of their Hessians, by conjugate
/// gradients with the bands' factors as preconditioner (Nocedal and Wright 2006, Alg. 5.3); for
/// each island its own ones.
///
/// The Hessian's product with a direction p needs no Hessian: with the preconditioner M, M p
/// follows from the residuals p is made of.
class Coupling {
 public:
  /// What is solved for.
  struct Problem {
    const std::vector<PackStep>& packs;       ///< factorised
    const std::vector<std::size_t>& offsets;  ///< of the packs in the step
    const std::vector<LaneIslands>& islands;  ///< by pack
    const std::vector<double>& decreases;     ///< by island: what the step by the bands alone
                                              ///< promises [J]; 0 where there is none to find
    const ContactTerms& contacts;
    const std::vector<std::size_t>& places;  ///< of nodes in the step
  };

  /// Makes the step by the bands alone the one by the whole Hessian.
  /// @param step of all packs
  void correct(const Problem& problem, std::vector<SimdBatch>& step) {
    constexpr int most_iterations = 200;
    begin(problem, step);
    for (int i = 0; i < most_iterations && is_any_solving(problem.decreases); ++i) {
      find_image(problem);
      advance(problem, step);
      turn(problem);
    }
  }

 private:
  /// Of conjugate gradients, for an island.
  struct Numbers {
    double norm = 0.0;     // squared: of the residual, as the preconditioner sees it
    double forward = 0.0;  // share of the direction that is gone
    double growth = 0.0;   // of the norm
    bool is_solving = true;
  };

  /// By lane of a pack, what holds for its islands.
  template <class Value>
  static SimdBatch by_lane(const PackStep& pack, const LaneIslands& islands, const Value& value) {
    SimdBatch values;
    for (std::size_t lane = 0; lane < pack.rods().used; ++lane) {
      values[lane] = value(islands[lane]);
    }
    return values;
  }

  /// Calls function(pack, first, size): the pack's values begin at the first of all, and are so
  /// many.
  template <class Function>
  static void for_each_part(const Problem& problem, Work work, const Function& function) {
    for_each_pack(problem.packs.size(), work, [&](std::size_t pack) {
      function(pack, problem.offsets[pack],
               SumSize{problem.packs[pack].step_size(), problem.packs[pack].rods().used});
    });
  }

  /// Of the packs' partial sums, by island.
  std::vector<double> sums(const Problem& problem) const {
    std::vector<double> sums(numbers_.size(), 0.0);
    for (std::size_t pack = 0; pack < problem.packs.size(); ++pack) {
      for (std::size_t lane = 0; lane < problem.packs[pack].rods().used; ++lane) {
        sums[problem.islands[pack][lane]] += partial_sums_[pack][lane];
      }
    }
    return sums;
  }

  /// From the step without contacts between rods: these are its residual.
  void begin(const Problem& problem, const std::vector<SimdBatch>& step) {
    numbers_.assign(problem.decreases.size(), Numbers{});
    partial_sums_.resize(problem.packs.size());
    for (auto* values : {&residual_, &preconditioned_, &direction_, &product_, &image_}) {
      values->resize(step.size());
    }
    for (std::size_t i = 0; i < step.size(); ++i) {
      for (std::size_t lane = 0; lane < lane_count; ++lane) {
        image_[i][lane] = -step[i][lane];
      }
      residual_[i] = SimdBatch{};
    }
    add_coupling(problem.contacts, problem.places, image_.data(), residual_.data());
    for_each_part(problem, Work::MUCH, [&](std::size_t pack, std::size_t first, SumSize size) {
      std::copy_n(&residual_[first], size.count, &direction_[first]);
      solve_band(problem.packs[pack].system(), &direction_[first]);
      std::copy_n(&residual_[first], size.count, &product_[first]);
      partial_sums_[pack] = products(size, &residual_[first], &direction_[first]);
    });
    const std::vector<double> norms = sums(problem);
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
      numbers_[i].norm = norms[i];
    }
  }

  /// Whether there are islands whose step is not yet what it is to be.
  bool is_any_solving(const std::vector<double>& decreases) {
    constexpr double tolerance = 1e-3;  // of the residual, as the preconditioner sees it
    bool is_any = false;
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
      const double small = tolerance * tolerance * std::max(0.0, decreases[i]);
      numbers_[i].is_solving &= numbers_[i].norm > small;
      is_any |= numbers_[i].is_solving;
    }
    return is_any;
  }

  /// And how far to go along the direction.
  void find_image(const Problem& problem) {
    image_ = product_;
    add_coupling(problem.contacts, problem.places, direction_.data(), image_.data());
    for_each_part(problem, Work::LITTLE, [&](std::size_t pack, std::size_t first, SumSize size) {
      partial_sums_[pack] = products(size, &direction_[first], &image_[first]);
    });
    const std::vector<double> curvatures = sums(problem);
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
      Numbers& numbers = numbers_[i];
      numbers.is_solving &= curvatures[i] > 0.0 && std::isfinite(curvatures[i]);
      numbers.forward = numbers.is_solving ? numbers.norm / curvatures[i] : 0.0;
      numbers.growth = numbers.is_solving ? 1.0 / numbers.norm : 0.0;
    }
  }

  void advance(const Problem& problem, std::vector<SimdBatch>& step) {
    for_each_part(problem, Work::MUCH, [&](std::size_t pack, std::size_t first, SumSize size) {
      const PackStep& of_pack = problem.packs[pack];
      const auto forward = [&](double sign) {
        return by_lane(of_pack, problem.islands[pack],
                       [&](std::uint32_t island) { return sign * numbers_[island].forward; });
      };
      move_by(size, &step[first], &direction_[first], forward(1.0), &step[first]);
      move_by(size, &residual_[first], &image_[first], forward(-1.0), &residual_[first]);
      std::copy_n(&residual_[first], size.count, &preconditioned_[first]);
      solve_band(of_pack.system(), &preconditioned_[first]);
      partial_sums_[pack] = products(size, &residual_[first], &preconditioned_[first]);
    });
    const std::vector<double> norms = sums(problem);
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
      numbers_[i].norm = norms[i];
      numbers_[i].growth *= norms[i];
    }
  }

  /// Into the next direction.
  void turn(const Problem& problem) {
    for_each_part(problem, Work::LITTLE, [&](std::size_t pack, std::size_t first, SumSize size) {
      const SimdBatch growth =
          by_lane(problem.packs[pack], problem.islands[pack],
                  [&](std::uint32_t island) { return numbers_[island].growth; });
      move_by(size, &preconditioned_[first], &direction_[first], growth, &direction_[first]);
      move_by(size, &residual_[first], &product_[first], growth, &product_[first]);
    });
  }

  std::vector<Numbers> numbers_;         // by island
  std::vector<SimdBatch> partial_sums_;  // by pack
  std::vector<SimdBatch> residual_;
  std::vector<SimdBatch> preconditioned_;
  std::vector<SimdBatch> direction_;
  std::vector<SimdBatch> product_;  // of the preconditioner and the direction
  std::vector<SimdBatch> image_;    // of the direction
};

}  // namespace fiber
