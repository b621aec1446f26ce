#pragma once

#include <cstddef>
#include <vector>

#include "src/sim/solver/pack_data.hpp"

namespace fiber {

/// Adds Rods::mass_couplings to the incremental potential of a pack: for each rigid part, with the
/// ways e of its ends from where inertia alone would bring them, −½ c |e₁ − e₂|² / h². Together
/// with the inertias of the nodes it is positive definite.
class MassCouplings {
 public:
  void assign(const Rods& rods, const RodPack& pack) {
    edges_.clear();
    if (rods.mass_couplings.empty()) {
      return;
    }
    for (std::uint32_t edge = 0; edge + 1 < pack.node_count; ++edge) {
      SimdBatch masses;
      bool is_any = false;
      for (std::size_t lane = 0; lane < lane_count; ++lane) {
        masses[lane] = rods.mass_couplings[pack.first_nodes[lane] + edge];
        is_any = is_any || masses[lane] != 0.0;
      }
      if (is_any) {
        edges_.push_back({edge, masses});
      }
    }
  }

  /// Adds Σ −c |e₁ − e₂|², by lane.
  void add_squares(const RodPack& pack, const std::vector<SimdBatch>& predicted,
                   SimdBatch& sums) const {
    for (const Edge& each : edges_) {
      for (std::size_t i = each.edge * pack.unknowns, k = 0; k < 3; ++i, ++k) {
        for (std::size_t lane = 0; lane < lane_count; ++lane) {
          const double difference = difference_at(pack, predicted, i, lane);
          sums[lane] -= each.masses[lane] * difference * difference;
        }
      }
    }
  }

  /// Adds its derivatives.
  /// @param factor 1 / h²
  void add_derivatives(const RodPack& pack, const std::vector<SimdBatch>& predicted, double factor,
                       PackSystem& system) const {
    const std::size_t unknowns = pack.unknowns;
    const std::size_t height = half_bandwidth(unknowns) + 1;
    for (const Edge& each : edges_) {
      for (std::size_t i = each.edge * unknowns, k = 0; k < 3; ++i, ++k) {
        const std::size_t j = i + unknowns;
        for (std::size_t lane = 0; lane < lane_count; ++lane) {
          const double coupling = factor * each.masses[lane];
          const double gradient = coupling * difference_at(pack, predicted, i, lane);
          system.gradient[i][lane] += gradient;
          system.gradient[j][lane] -= gradient;
          system.hessian[i * height][lane] -= coupling;
          system.hessian[j * height][lane] -= coupling;
          system.hessian[i * height + unknowns][lane] += coupling;
        }
      }
    }
  }

 private:
  struct Edge {
    std::uint32_t edge;
    SimdBatch masses;  // [kg]
  };

  /// e₂ − e₁ in a coordinate of the first node.
  static double difference_at(const RodPack& pack, const std::vector<SimdBatch>& predicted,
                              std::size_t i, std::size_t lane) {
    const std::size_t j = i + pack.unknowns;
    return (pack.positions[j][lane] - predicted[j][lane]) -
           (pack.positions[i][lane] - predicted[i][lane]);
  }

  std::vector<Edge> edges_;  // that are rigid in some lane
};

}  // namespace fiber
