#pragma once

#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

/// Resistance of a round rod to bending: ½ EI/l (|k| − k₀)² at each inner node, with the turn k of
/// EdgePair and the length l that belongs to the node (Bergou et al. 2008, Sect. 4.2).
///
/// Rods::natural_curvatures, if there are any, give k₀. Without twist they have no direction: a
/// cross-section that may turn about the tangent without effort lets the rod bend to any side.
/// Rods::natural_curvature_vectors have one, which cross-sections carry along: the energy is then
/// that of the turn away from the natural one.
class Bend : public Effect {
 public:
  double energy(const Rods& rods, std::uint32_t rod) const override;
  void add_derivatives(const Rods& rods, std::uint32_t rod, RodSystem& system) const override;

  void begin_step(Rods& rods, const TimeStep& step) override;

  bool works_in_lanes(const Rods& rods) const override {
    return rods.natural_curvature_vectors.empty();
  }
  std::uint32_t values_per_node() const override { return natural_turns_.empty() ? 0 : 1; }
  const double* values_of(std::uint32_t node) const override { return &natural_turns_[node]; }
  void energy_in_lanes(const RodLanes& rods, const std::vector<Lanes>& values,
                       Lanes& energy) const override;
  void add_derivatives_in_lanes(const RodLanes& rods, const std::vector<Lanes>& values,
                                LaneSystem& system) const override;

 private:
  std::vector<double> natural_turns_;  // k₀ of inner nodes in this step; empty: all are 0
};

}  // namespace fiber
