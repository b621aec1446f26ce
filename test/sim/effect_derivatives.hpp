#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>
#include <vector>

#include "fiber_proximity/sim/effect.hpp"
#include "sim/rod_batch.hpp"

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

/// What was added to the system of a rod with so many nodes.
inline Derivatives derivatives_in(const RodSystem& system, std::uint32_t node_count) {
  const auto size = static_cast<Eigen::Index>(node_count * system.unknowns());
  Derivatives derivatives{Eigen::VectorXd(size), Eigen::MatrixXd::Zero(size, size)};
  const auto width = static_cast<Eigen::Index>(half_bandwidth(system.unknowns()));
  for (Eigen::Index c = 0; c < size; ++c) {
    derivatives.gradient[c] = system.gradient(static_cast<std::size_t>(c));
    for (Eigen::Index r = c; r < std::min(size, c + width + 1); ++r) {
      derivatives.hessian(r, c) = derivatives.hessian(c, r) =
          system.hessian(static_cast<std::size_t>(r), static_cast<std::size_t>(c));
    }
  }
  return derivatives;
}

inline Derivatives derivatives_of(const Effect& effect, const Rods& rods, std::uint32_t rod) {
  PackSystem lanes(rods.node_count(rod), unknowns_of(rods));
  RodSystem system(lanes, 1);
  effect.add_derivatives(rods, rod, system);
  return derivatives_in(system, rods.node_count(rod));
}

/// As the stepper moves all of them, which have equal sizes, side by side.
struct SideBySide {
  std::vector<double> energies;
  std::vector<Derivatives> derivatives;
};
inline SideBySide side_by_side(const Effects& effects, Rods rods) {
  // In so long a step nothing has inertia, and it ends where the rods are now.
  constexpr double step = 1e100;
  std::fill(rods.velocities.begin(), rods.velocities.end(), Eigen::Vector3d::Zero());
  std::fill(rods.spins.begin(), rods.spins.end(), 0.0);
  rods.held.clear();
  std::vector<std::uint32_t> all(rods.count());
  std::iota(all.begin(), all.end(), 0U);
  RodBatch batch;
  batch.assign(rods, all);
  batch.begin(rods, effects, step);
  batch.measure(rods, effects);
  batch.assemble(rods, effects);
  SideBySide found;
  for (const std::uint32_t rod : all) {
    found.energies.push_back(batch.merit(rod).energy);
    found.derivatives.push_back(derivatives_in(batch.system(rod), rods.node_count(rod)));
  }
  return found;
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
