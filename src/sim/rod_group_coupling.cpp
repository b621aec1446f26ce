// The equations of rods that contacts join.

#include <algorithm>
#include <cmath>

#include "lane_sums.hpp"
#include "rod_group.hpp"

namespace fiber {
namespace {

using Numbers = Eigen::Map<Eigen::VectorXd>;

Numbers numbers(std::vector<Lanes>& values) {
  return {values.data()->of.data(), static_cast<Eigen::Index>(values.size() * lane_count)};
}

}  // namespace

/// Conjugate gradients for what joins rods, from the step without it, with the factors of the rods
/// as preconditioner: for each island its own. The Hessian's product with a direction p needs no
/// Hessian: with the preconditioner M, M p follows from the residuals p is made of.
void RodGroup::correct_step() {
  constexpr int most_iterations = 100;
  constexpr double tolerance = 1e-3;  // of the residual, in the preconditioner's norm
  const auto add_coupling = [this](std::vector<Lanes>& values, std::vector<Lanes>& product) {
    contacts_->add_coupling(places_, numbers(values).data(), numbers(product).data());
  };
  auto& [residual, preconditioned, direction, product, image] = gradients_;
  numbers(image) = -numbers(step_);
  numbers(residual).setZero();
  add_coupling(image, residual);
  precondition(residual, direction);
  product = residual;
  sum_products(residual, direction, &Search::norm);
  for (Search& search : searches_) {
    search.is_solving = true;
  }
  for (int i = 0; i < most_iterations && is_any_solving(tolerance * tolerance); ++i) {
    image = product;
    add_coupling(direction, image);
    sum_products(direction, image, &Search::curvature);
    for (Search& search : searches_) {
      search.is_solving &= search.curvature > 0.0 && std::isfinite(search.curvature);
      search.forward = search.is_solving ? search.norm / search.curvature : 0.0;
      search.back = -search.forward;
      search.growth = search.is_solving ? 1.0 / search.norm : 0.0;
    }
    add_shares(step_, direction, &Search::forward, step_);
    add_shares(residual, image, &Search::back, residual);
    precondition(residual, preconditioned);
    sum_products(residual, preconditioned, &Search::norm);
    for (Search& search : searches_) {
      search.growth *= search.norm;
    }
    add_shares(preconditioned, direction, &Search::growth, direction);
    add_shares(residual, product, &Search::growth, product);
  }
}

/// Whether there are searches whose step is not yet what it is to be.
bool RodGroup::is_any_solving(double tolerance) {
  bool is_any = false;
  for (Search& search : searches_) {
    search.is_solving &= search.norm > tolerance * search.decrease;
    is_any |= search.is_solving;
  }
  return is_any;
}

/// Few rods are solved for sooner than threads are told to.
void RodGroup::precondition(const std::vector<Lanes>& values, std::vector<Lanes>& preconditioned) {
  preconditioned = values;
  for (std::size_t batch = 0; batch < batches_.size(); ++batch) {
    batches_[batch].solve(part(preconditioned, batch));
  }
}

/// Σ a · b over the rods of each search.
void RodGroup::sum_products(const std::vector<Lanes>& a, const std::vector<Lanes>& b,
                            double Search::*sum) {
  for (Search& search : searches_) {
    search.*sum = 0.0;
  }
  for (std::size_t batch = 0; batch < batches_.size(); ++batch) {
    const std::size_t first = offsets_[batch];
    const Lanes sums = products(batches_[batch].step_size(), &a[first], &b[first]);
    for (std::size_t lane = 0; lane < batches_[batch].used(); ++lane) {
      search_of(batch, lane).*sum += sums[lane];
    }
  }
}

/// sum = a + share · b, with each search's own share.
void RodGroup::add_shares(const std::vector<Lanes>& a, const std::vector<Lanes>& b,
                          double Search::*share, std::vector<Lanes>& sum) {
  for (std::size_t batch = 0; batch < batches_.size(); ++batch) {
    const std::size_t first = offsets_[batch];
    move_by(batches_[batch].step_size(), &a[first], &b[first], by_lane(batch, share), &sum[first]);
  }
}

}  // namespace fiber
