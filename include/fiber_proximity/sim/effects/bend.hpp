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
  void begin_step(Rods& rods, const TimeStep& step) override;
  void add_forces(const RodPack& rods, const std::vector<SimdBatch>& values,
                  RodForces& forces) const override;

  std::uint32_t values_per_node() const override;
  const double* values_of(std::uint32_t node) const override;
  void energy(const RodPack& rods, const std::vector<SimdBatch>& values,
              SimdBatch& energy) const override;
  void add_derivatives(const RodPack& rods, const std::vector<SimdBatch>& values,
                       PackSystem& system) const override;

 private:
  // Of inner nodes in this step; of the two at most one is not empty.
  std::vector<double> natural_turns_;                // k₀
  std::vector<Eigen::Vector2d> natural_curvatures_;  // with a direction [1/m]
};

}  // namespace fiber
