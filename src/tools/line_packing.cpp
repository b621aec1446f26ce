#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "src/tools/direction_search.hpp"

namespace fiber {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Frame = Eigen::Matrix<double, 3, 2>;

/// Interior-point method for: minimise m subject to (u_i · u_j)² ≤ m² for all pairs of lines.
/// The point in between is a minimum of F = weight · m − Σ log(m² − (u_i · u_j)²), which follows a
/// smooth path to the solution as the weight grows. Unknowns: two tangential coordinates for every
/// line, then m.
class Packing {
 public:
  Packing(std::vector<Vector3d> lines, double weight)
      : lines_(std::move(lines)), bound_(1.05), weight_(weight) {}

  const std::vector<Vector3d>& lines() const { return lines_; }
  double bound() const { return bound_; }
  double weight() const { return weight_; }

  /// Newton steps until F is nearly least for the present weight.
  void centre(double tolerance, int most_steps) {
    for (int step = 0; step < most_steps; ++step) {
      assemble();
      const VectorXd direction = solve(-gradient_);
      const double decrement = -gradient_.dot(direction);
      if (!(decrement > tolerance) || !descend(direction, decrement)) {
        return;
      }
    }
  }

  /// Multiplies the weight and moves along the tangent of the path. Returns where m would end if
  /// the tangent were followed to an infinite weight.
  double advance(double factor) {
    assemble();
    VectorXd slope = VectorXd::Zero(gradient_.size());
    slope[slope.size() - 1] = -weight_;
    const VectorXd tangent = solve(slope);
    const double limit = bound_ + tangent[tangent.size() - 1];
    double fraction = 1.0 - 1.0 / factor;
    for (int attempt = 0; attempt < most_attempts; ++attempt, fraction *= 0.5) {
      const Packing trial = moved(fraction * tangent);
      if (std::isfinite(trial.value())) {
        lines_ = trial.lines_;
        bound_ = trial.bound_;
        break;
      }
    }
    weight_ *= factor;
    return limit;
  }

 private:
  static constexpr int most_attempts = 20;  // halvings of a step, down to a millionth

  Index size() const { return static_cast<Index>(lines_.size()); }

  double value() const {
    double sum = 0.0;
    for (Index i = 0; i < size(); ++i) {
      for (Index j = 0; j < i; ++j) {
        const double cosine = lines_[i].dot(lines_[j]);
        const double slack = (bound_ - cosine) * (bound_ + cosine);
        if (!(slack > 0.0)) {
          return std::numeric_limits<double>::infinity();
        }
        sum += std::log(slack);
      }
    }
    return weight_ * bound_ - sum;
  }

  void assemble() {
    const Index last = 2 * size();
    frames_.resize(lines_.size());
    for (Index i = 0; i < size(); ++i) {
      frames_[i].col(0) = lines_[i].unitOrthogonal();
      frames_[i].col(1) = lines_[i].cross(frames_[i].col(0));
    }
    gradient_.setZero(last + 1);
    hessian_.setZero(last + 1, last + 1);
    gradient_[last] = weight_;
    for (Index i = 0; i < size(); ++i) {
      for (Index j = 0; j < i; ++j) {
        add_pair(i, j);
      }
    }
  }

  /// Adds the derivatives of −log(m² − c²), c = u_i · u_j, to the lower triangle.
  void add_pair(Index i, Index j) {
    const Index last = 2 * size();
    const double cosine = lines_[i].dot(lines_[j]);
    const double slack = (bound_ - cosine) * (bound_ + cosine);
    const Eigen::Vector2d at_i = frames_[i].transpose() * lines_[j];
    const Eigen::Vector2d at_j = frames_[j].transpose() * lines_[i];
    const double first = 2.0 * cosine / slack;
    const double second = 2.0 / slack + first * first;
    const double mixed = -first * 2.0 * bound_ / slack;
    gradient_.segment<2>(2 * i) += first * at_i;
    gradient_.segment<2>(2 * j) += first * at_j;
    gradient_[last] -= 2.0 * bound_ / slack;
    // On the sphere a step a in the tangent plane also shortens the vector by a²/2.
    const Eigen::Matrix2d curvature = -first * cosine * Eigen::Matrix2d::Identity();
    hessian_.block<2, 2>(2 * i, 2 * i) += second * at_i * at_i.transpose() + curvature;
    hessian_.block<2, 2>(2 * j, 2 * j) += second * at_j * at_j.transpose() + curvature;
    hessian_.block<2, 2>(2 * i, 2 * j) +=
        second * at_i * at_j.transpose() + first * frames_[i].transpose() * frames_[j];
    hessian_.block<1, 2>(last, 2 * i) += mixed * at_i.transpose();
    hessian_.block<1, 2>(last, 2 * j) += mixed * at_j.transpose();
    hessian_(last, last) += (4.0 * bound_ * bound_ / slack - 2.0) / slack;
  }

  /// Solves with the Hessian, made positive definite by as little damping as that takes: F is not
  /// convex, and does not change when the whole set turns.
  VectorXd solve(const VectorXd& right_side) {
    constexpr double least_damping = 1e-13;
    const VectorXd diagonal = hessian_.diagonal();
    for (bool raised = false;; raised = true) {
      hessian_.diagonal() = diagonal.array() + damping_ * (diagonal.array().abs() + 1.0);
      factorisation_.compute(hessian_);
      if (factorisation_.info() == Eigen::Success) {
        damping_ = raised ? damping_ : std::max(0.1 * damping_, least_damping);
        return factorisation_.solve(right_side);
      }
      damping_ = std::max(8.0 * damping_, 1e-6);
    }
  }

  bool descend(const VectorXd& direction, double decrement) {
    constexpr double largest_turn = 0.3;  // [rad], where the tangent plane still tells the way
    const Index last = 2 * size();
    const double turn = direction.head(last).lpNorm<Eigen::Infinity>();
    const double before = value();
    double fraction =
        std::min({1.0, largest_turn / turn, 0.5 * bound_ / std::abs(direction[last])});
    for (int attempt = 0; attempt < most_attempts; ++attempt, fraction *= 0.5) {
      const Packing trial = moved(fraction * direction);
      if (trial.value() < before - 1e-4 * fraction * decrement) {
        lines_ = trial.lines_;
        bound_ = trial.bound_;
        return true;
      }
    }
    return false;
  }

  Packing moved(const VectorXd& step) const {
    Packing result(lines_, weight_);
    for (Index i = 0; i < size(); ++i) {
      result.lines_[i] = (lines_[i] + frames_[i] * step.segment<2>(2 * i)).normalized();
    }
    result.bound_ = bound_ + step[2 * size()];
    return result;
  }

  std::vector<Vector3d> lines_;
  double bound_;
  double weight_;
  double damping_ = 1e-6;
  std::vector<Frame> frames_;
  VectorXd gradient_;
  MatrixXd hessian_;
  Eigen::LLT<MatrixXd> factorisation_;
};

}  // namespace

std::vector<Vector3d> pack_lines(std::vector<Vector3d> lines, double smoothness, double target) {
  assert(lines.size() >= 2 && smoothness > 0.0);
  constexpr double last_weight = 1e13;  // m then errs by about its reciprocal times the contacts
  const double pairs = 0.5 * static_cast<double>(lines.size() * (lines.size() - 1));
  Packing packing(std::move(lines), pairs / smoothness);
  packing.centre(0.3, 200);
  while (packing.weight() < last_weight) {
    const double before = packing.bound();
    const double limit = packing.advance(30.0);
    // The forecast errs by a part of the gain it foretells, on either side.
    if (limit - 0.3 * (before - limit) > std::cos(target)) {
      break;
    }
    packing.centre(0.3, 200);
  }
  packing.centre(1e-6, 20);
  return packing.lines();
}

}  // namespace fiber
