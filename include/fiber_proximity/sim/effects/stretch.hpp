#pragma once

#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

/// Resistance of edges to change their lengths: ½ EA l (|e|/l − 1)² each, with the edge e and its
/// length l at rest (Bergou et al. 2010, Sect. 4.1).
class Stretch : public Effect {
 public:
  void energy(const RodPack& rods, const std::vector<SimdBatch>& values,
              SimdBatch& energy) const override;
  void add_derivatives(const RodPack& rods, const std::vector<SimdBatch>& values,
                       PackSystem& system) const override;

  void add_forces(const RodPack& rods, const std::vector<SimdBatch>& values,
                  RodForces& forces) const override;
};

}  // namespace fiber
