#include "coupling.hpp"

#include <algorithm>
#include <cmath>

#include "pack_sums.hpp"

namespace fiber {
namespace {

/// Adds what contacts between rods bring for these values to a product.
void add_coupling(const Coupling::Problem& problem, const std::vector<SimdBatch>& values,
                  std::vector<SimdBatch>& product) {
  problem.contacts.add_coupling(problem.places, values.data()->of.data(),
                                product.data()->of.data());
}

}  // namespace

/// The Hessian's product with a direction p needs no Hessian: with the preconditioner M, M p
/// follows from the residuals p is made of.
void Coupling::correct(const Problem& problem, std::vector<SimdBatch>& step) {
  constexpr int most_iterations = 200;
  begin(problem, step);
  for (int i = 0; i < most_iterations && is_any_solving(problem.decreases); ++i) {
    image_ = product_;
    add_coupling(problem, direction_, image_);
    sum_products(problem, direction_, image_, &Numbers::curvature);
    choose_shares();
    add_shares(problem, step, direction_, &Numbers::forward, step);
    add_shares(problem, residual_, image_, &Numbers::back, residual_);
    precondition(problem, residual_, preconditioned_);
    sum_products(problem, residual_, preconditioned_, &Numbers::norm);
    for (Numbers& numbers : numbers_) {
      numbers.growth *= numbers.norm;
    }
    add_shares(problem, preconditioned_, direction_, &Numbers::growth, direction_);
    add_shares(problem, residual_, product_, &Numbers::growth, product_);
  }
}

/// From the step without contacts between rods: these are its residual.
void Coupling::begin(const Problem& problem, const std::vector<SimdBatch>& step) {
  numbers_.assign(problem.decreases.size(), Numbers{});
  image_.resize(step.size());
  residual_.resize(step.size());
  for (std::size_t i = 0; i < step.size(); ++i) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      image_[i][lane] = -step[i][lane];
      residual_[i][lane] = 0.0;
    }
  }
  add_coupling(problem, image_, residual_);
  precondition(problem, residual_, direction_);
  product_ = residual_;
  sum_products(problem, residual_, direction_, &Numbers::norm);
}

/// Whether there are islands whose step is not yet what it is to be.
bool Coupling::is_any_solving(const std::vector<double>& decreases) {
  constexpr double tolerance = 1e-3;  // of the residual, as the preconditioner sees it
  bool is_any = false;
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    const double small = tolerance * tolerance * std::max(0.0, decreases[i]);
    numbers_[i].is_solving &= numbers_[i].norm > small;
    is_any |= numbers_[i].is_solving;
  }
  return is_any;
}

void Coupling::choose_shares() {
  for (Numbers& numbers : numbers_) {
    numbers.is_solving &= numbers.curvature > 0.0 && std::isfinite(numbers.curvature);
    numbers.forward = numbers.is_solving ? numbers.norm / numbers.curvature : 0.0;
    numbers.back = -numbers.forward;
    numbers.growth = numbers.is_solving ? 1.0 / numbers.norm : 0.0;
  }
}

/// Few rods are solved for sooner than threads are told to.
void Coupling::precondition(const Problem& problem, const std::vector<SimdBatch>& values,
                            std::vector<SimdBatch>& preconditioned) {
  preconditioned = values;
  for (std::size_t pack = 0; pack < problem.packs.size(); ++pack) {
    problem.packs[pack].solve(&preconditioned[problem.offsets[pack]]);
  }
}

/// Σ a · b over each island.
void Coupling::sum_products(const Problem& problem, const std::vector<SimdBatch>& a,
                            const std::vector<SimdBatch>& b, double Numbers::*sum) {
  for (Numbers& numbers : numbers_) {
    numbers.*sum = 0.0;
  }
  for (std::size_t pack = 0; pack < problem.packs.size(); ++pack) {
    const std::size_t first = problem.offsets[pack];
    const SimdBatch sums = products({problem.packs[pack].step_size(), problem.packs[pack].used()},
                                    &a[first], &b[first]);
    for (std::size_t lane = 0; lane < problem.packs[pack].used(); ++lane) {
      numbers_[problem.islands[pack][lane]].*sum += sums[lane];
    }
  }
}

/// sum = a + share · b, with each island's share.
void Coupling::add_shares(const Problem& problem, const std::vector<SimdBatch>& a,
                          const std::vector<SimdBatch>& b, double Numbers::*share,
                          std::vector<SimdBatch>& sum) const {
  for (std::size_t pack = 0; pack < problem.packs.size(); ++pack) {
    SimdBatch shares;
    for (std::size_t lane = 0; lane < problem.packs[pack].used(); ++lane) {
      shares[lane] = numbers_[problem.islands[pack][lane]].*share;
    }
    const std::size_t first = problem.offsets[pack];
    move_by({problem.packs[pack].step_size(), problem.packs[pack].used()}, &a[first], &b[first],
            shares, &sum[first]);
  }
}

}  // namespace fiber
