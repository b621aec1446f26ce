#include "fiber_proximity/sim/effects/plasticity.hpp"

#include <algorithm>
#include <cmath>

#include "fiber_proximity/sim/edge_turn.hpp"
#include "src/sim/require.hpp"

namespace fiber {

Plasticity::Plasticity(Rods& rods, const Options& options) : options_(options) {
  require_positive("plasticity: the yield strain", options.yield_strain);
  require(options.hardening >= 0.0 && options.hardening < 1.0, "plasticity: the hardening",
          options.hardening, "", "at least 0 and less than 1");
  if (!rods.natural_curvature_vectors.empty()) {
    throw std::invalid_argument(
        "plasticity: what stays has no direction, natural curvature must have none, too");
  }
  rods.natural_curvatures.resize(rods.positions.size(), 0.0);
}

void Plasticity::end_step(Rods& rods, const TimeStep& /*step*/) {
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    const double yield = options_.yield_strain / rods.radii[rod];
    for (std::uint32_t i = rods.first(rod) + 1; i + 1 < rods.end(rod); ++i) {
      const double half_turn = std::min(1.0, 0.5 * EdgeTurn(rods, i).turn().norm());
      const double curvature = 2.0 * std::asin(half_turn) / rods.rest_length_at(i);
      const double elastic = curvature - rods.natural_curvatures[i];
      const double excess = std::abs(elastic) - yield;
      if (excess > 0.0) {
        rods.natural_curvatures[i] += std::copysign((1.0 - options_.hardening) * excess, elastic);
      }
    }
  }
}

}  // namespace fiber
