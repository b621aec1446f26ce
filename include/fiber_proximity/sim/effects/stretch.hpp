#pragma once

#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

/// Resistance of edges to change their lengths: ½ EA l (|e|/l − 1)² each, with the edge e and its
/// length l at rest (Bergou et al. 2010, Sect. 4.1).
class Stretch : public Effect {
 public:
  double energy(const Rods& rods, std::uint32_t rod) const override;
  void add_derivatives(const Rods& rods, std::uint32_t rod, RodSystem& system) const override;

  bool works_in_lanes(const Rods& /*rods*/) const override { return true; }
  void energy_in_lanes(const RodLanes& rods, const std::vector<Lanes>& values,
                       Lanes& energy) const override;
  void add_derivatives_in_lanes(const RodLanes& rods, const std::vector<Lanes>& values,
                                LaneSystem& system) const override;
};

}  // namespace fiber
