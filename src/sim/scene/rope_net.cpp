#include "src/sim/scene/rope_net.hpp"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace fiber {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Ends = std::vector<Vector3d>;

/// Lengths below that part of the ropes' length count as rounding.
constexpr double min_share = 1e-9;

class Energy {
 public:
  explicit Energy(const RopeNet& net) : net_(net) {
    for (const RopeNet::Rope& rope : net.ropes) {
      total_length_ += rope.length;
    }
    // Rope of no length is stiff, but not more than Newton's method can bear.
    const double mean = total_length_ / static_cast<double>(net.ropes.size());
    for (const RopeNet::Rope& rope : net.ropes) {
      stiffness_.push_back(mean > 0.0 ? 1.0 / std::max(rope.length, 1e-3 * mean) : 1.0);
    }
  }

  double excess(std::size_t rope, const Ends& ends) const {
    return std::max(0.0, vector(rope, ends).norm() - net_.ropes[rope].length);
  }

  double value(const Ends& ends) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < net_.ropes.size(); ++i) {
      const double by = excess(i, ends);
      sum += 0.5 * stiffness_[i] * by * by;
    }
    return sum;
  }

  std::vector<double> tensions(const Ends& ends) const {
    std::vector<double> tensions;
    for (std::size_t i = 0; i < net_.ropes.size(); ++i) {
      tensions.push_back(stiffness_[i] * excess(i, ends));
    }
    return tensions;
  }

  VectorXd gradient(const Ends& ends) const {
    VectorXd sum = VectorXd::Zero(size());
    for (std::size_t i = 0; i < net_.ropes.size(); ++i) {
      const Vector3d way = vector(i, ends);
      const double by = excess(i, ends);
      if (by > 0.0) {
        const Vector3d pull = stiffness_[i] * by / way.norm() * way;
        add(net_.ropes[i].to, pull, sum);
        add(net_.ropes[i].from, -pull, sum);
      }
    }
    return sum;
  }

  /// Whether tensions that leave over `gradient` at joints are the proof all the same: no joint
  /// that has a place is further from it than the ropes and all ends together.
  bool is_proof(const Ends& ends, const VectorXd& gradient) const {
    double left_over = 0.0;
    for (std::size_t i = 0; i < net_.joint_count; ++i) {
      left_over += gradient.segment<3>(static_cast<Eigen::Index>(3 * i)).norm();
    }
    Eigen::AlignedBox3d box;
    for (const Vector3d& end : ends) {
      box.extend(end);
    }
    double work = 0.0;
    double tension = 0.0;
    for (std::size_t i = 0; i < net_.ropes.size(); ++i) {
      const double by = excess(i, ends);
      work += stiffness_[i] * by * by;
      tension += stiffness_[i] * by;
    }
    return work > left_over * (total_length_ + box.diagonal().norm()) +
                      min_share * total_length_ * tension;
  }

  /// Newton's step. What no rope pulls at stays where it is.
  VectorXd step(const Ends& ends, const VectorXd& gradient) const {
    std::vector<Eigen::Triplet<double>> entries;
    const auto add_block = [&](std::size_t row, std::size_t column, const Matrix3d& block) {
      if (row >= net_.joint_count || column >= net_.joint_count) {
        return;
      }
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          entries.emplace_back(static_cast<int>(3 * row) + i, static_cast<int>(3 * column) + j,
                               block(i, j));
        }
      }
    };
    for (std::size_t i = 0; i < net_.ropes.size(); ++i) {
      const double by = excess(i, ends);
      if (!(by > 0.0)) {
        continue;
      }
      const Vector3d way = vector(i, ends);
      const Matrix3d along = way * way.transpose() / way.squaredNorm();
      const Matrix3d block =
          stiffness_[i] * (along + by / way.norm() * (Matrix3d::Identity() - along));
      const auto [from, to, length] = net_.ropes[i];
      add_block(from, from, block);
      add_block(to, to, block);
      add_block(from, to, -block);
      add_block(to, from, -block);
    }
    const double shift = 1e-10 * *std::max_element(stiffness_.begin(), stiffness_.end());
    for (int i = 0; i < size(); ++i) {
      entries.emplace_back(i, i, shift);
    }
    Eigen::SparseMatrix<double> hessian(size(), size());
    hessian.setFromTriplets(entries.begin(), entries.end());
    return -Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(hessian).solve(gradient);
  }

  Ends moved(const Ends& ends, const VectorXd& step) const {
    Ends moved = ends;
    for (std::size_t i = 0; i < net_.joint_count; ++i) {
      moved[i] += step.segment<3>(static_cast<Eigen::Index>(3 * i));
    }
    return moved;
  }

 private:
  int size() const { return static_cast<int>(3 * net_.joint_count); }

  Vector3d vector(std::size_t rope, const Ends& ends) const {
    return ends[net_.ropes[rope].to] - ends[net_.ropes[rope].from];
  }

  void add(std::size_t end, const Vector3d& force, VectorXd& sum) const {
    if (end < net_.joint_count) {
      sum.segment<3>(static_cast<Eigen::Index>(3 * end)) += force;
    }
  }

  const RopeNet& net_;
  double total_length_ = 0.0;
  std::vector<double> stiffness_;  ///< [1/m] of ropes that stretch alike
};

}  // namespace

std::vector<double> tearing_tensions(const RopeNet& net, Ends ends) {
  constexpr int max_iterations = 100;
  const Energy energy(net);
  for (int i = 0; i < max_iterations; ++i) {
    const double before = energy.value(ends);
    if (before == 0.0) {
      return {};
    }
    const VectorXd gradient = energy.gradient(ends);
    if (energy.is_proof(ends, gradient)) {
      return energy.tensions(ends);
    }
    VectorXd step = energy.step(ends, gradient);
    const double slope = gradient.dot(step);
    Ends trial = energy.moved(ends, step);
    while (!(energy.value(trial) <= before + 1e-4 * slope)) {
      step *= 0.5;
      trial = energy.moved(ends, step);
      if (trial == ends) {
        return {};
      }
    }
    ends = std::move(trial);
  }
  return {};
}

}  // namespace fiber
