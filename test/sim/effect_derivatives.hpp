#pragma once

#include <Eigen/Dense>

#include "fiber_proximity/sim/effect.hpp"

namespace fiber::test {

/// What an effect adds to the system of one rod.
struct Derivatives {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
};

inline std::uint32_t unknowns_of(const Rods& rods) { return rods.angles.empty() ? 3 : 4; }

/// Unknown number `index` of a rod, counted through: (x, y, z[, angle]) node by node.
inline double& unknown(Rods& rods, std::uint32_t rod, std::uint32_t index) {
  const std::uint32_t node = rods.first(rod) + index / unknowns_of(rods);
  const std::uint32_t part = index % unknowns_of(rods);
  return part == 3 ? rods.angles[node] : rods.positions[node][part];
}

inline Derivatives derivatives_of(const Effect& effect, const Rods& rods, std::uint32_t rod) {
  const std::uint32_t unknowns = unknowns_of(rods);
  LaneSystem lanes(rods.node_count(rod), unknowns);
  RodSystem system(lanes, 1);
  effect.add_derivatives(rods, rod, system);
  const Eigen::Index size = rods.node_count(rod) * unknowns;
  Derivatives derivatives{Eigen::VectorXd(size), Eigen::MatrixXd::Zero(size, size)};
  const auto width = static_cast<Eigen::Index>(half_bandwidth(unknowns));
  for (Eigen::Index c = 0; c < size; ++c) {
    derivatives.gradient[c] = system.gradient(static_cast<std::size_t>(c));
    for (Eigen::Index r = c; r < std::min(size, c + width + 1); ++r) {
      derivatives.hessian(r, c) = derivatives.hessian(c, r) =
          system.hessian(static_cast<std::size_t>(r), static_cast<std::size_t>(c));
    }
  }
  return derivatives;
}

/// By central differences of the energy.
inline Eigen::VectorXd gradient_by_differences(const Effect& effect, Rods rods, std::uint32_t rod,
                                               double difference) {
  Eigen::VectorXd gradient(rods.node_count(rod) * unknowns_of(rods));
  for (std::uint32_t i = 0; i < gradient.size(); ++i) {
    double& x = unknown(rods, rod, i);
    const double middle = x;
    x = middle + difference;
    const double after = effect.energy(rods, rod);
    x = middle - difference;
    gradient[i] = (after - effect.energy(rods, rod)) / (2.0 * difference);
    x = middle;
  }
  return gradient;
}

/// By central differences of the gradient.
inline Eigen::MatrixXd hessian_by_differences(const Effect& effect, Rods rods, std::uint32_t rod,
                                              double difference) {
  const Eigen::Index size = rods.node_count(rod) * unknowns_of(rods);
  Eigen::MatrixXd hessian(size, size);
  for (std::uint32_t i = 0; i < size; ++i) {
    double& x = unknown(rods, rod, i);
    const double middle = x;
    x = middle + difference;
    const Eigen::VectorXd after = derivatives_of(effect, rods, rod).gradient;
    x = middle - difference;
    hessian.col(i) = (after - derivatives_of(effect, rods, rod).gradient) / (2.0 * difference);
    x = middle;
  }
  return hessian;
}

}  // namespace fiber::test
