#pragma once

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "fiber_proximity/sim/effect.hpp"
#include "src/sim/solver/pack_step.hpp"

namespace fiber::test {

/// The part of an effect in the system of one rod.
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

/// [J]
inline double energy_in(const Effect& effect, const RodPack& rods, std::size_t lane = 0) {
  SimdBatch energy;
  NodeValues values;
  load_values(effect, rods, values);
  effect.energy(rods, values, energy);
  return energy[lane];
}

/// Rods side by side where they are now, under an effect.
class PackedRods {
 public:
  /// @param members of equal sizes, at most lane_count of them
  PackedRods(const Effect& effect, const Rods& rods, const std::vector<std::uint32_t>& members)
      : effect_(effect) {
    step_.assign(rods, members);
    step_.begin(rods, {}, 1.0);
  }

  /// [J]
  double energy(std::size_t lane = 0) const { return energy_in(effect_, step_.rods(), lane); }

  Derivatives derivatives(std::size_t lane = 0) const {
    PackSystem system;
    system.resize(step_.rods().node_count, step_.rods().unknowns, step_.rods().used);
    system.set_zero();
    NodeValues values;
    load_values(effect_, step_.rods(), values);
    effect_.add_derivatives(step_.rods(), values, system);
    return derivatives_in(RodSystem(system, lane), static_cast<Eigen::Index>(system.size()));
  }

 private:
  static Derivatives derivatives_in(const RodSystem& system, Eigen::Index size) {
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

  const Effect& effect_;
  PackStep step_;
};

/// [J]
inline double energy_of(const Effect& effect, const Rods& rods, std::uint32_t rod) {
  return PackedRods(effect, rods, {rod}).energy();
}

/// Sum over all rods [J].
inline double energy_of(const Effect& effect, const Rods& rods) {
  double energy = 0.0;
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    energy += energy_of(effect, rods, rod);
  }
  return energy;
}

inline Derivatives derivatives_of(const Effect& effect, const Rods& rods, std::uint32_t rod) {
  return PackedRods(effect, rods, {rod}).derivatives();
}

/// The gradient, by central differences of the energy.
inline Eigen::VectorXd gradient_by_differences(const Effect& effect, Rods rods, std::uint32_t rod,
                                               double difference) {
  Eigen::VectorXd gradient(rods.node_count(rod) * unknowns_of(rods));
  for (std::uint32_t i = 0; i < gradient.size(); ++i) {
    double& x = unknown(rods, rod, i);
    const double middle = x;
    x = middle + difference;
    const double after = energy_of(effect, rods, rod);
    x = middle - difference;
    gradient[i] = (after - energy_of(effect, rods, rod)) / (2.0 * difference);
    x = middle;
  }
  return gradient;
}

/// The Hessian, by central differences of the gradient.
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

/// Checks that derivatives are the same to the last bit, whatever is in the other lanes.
inline void expect_same_side_by_side(const Effect& effect, const Rods& rods) {
  std::vector<std::uint32_t> all(rods.count());
  std::iota(all.begin(), all.end(), 0U);
  const PackedRods together(effect, rods, all);
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    SCOPED_TRACE("rod " + std::to_string(rod));
    ASSERT_EQ(together.energy(rod), energy_of(effect, rods, rod));
    const Derivatives found = together.derivatives(rod);
    const Derivatives expected = derivatives_of(effect, rods, rod);
    ASSERT_EQ(found.gradient, expected.gradient);
    ASSERT_EQ(found.hessian, expected.hessian);
  }
}

}  // namespace fiber::test
