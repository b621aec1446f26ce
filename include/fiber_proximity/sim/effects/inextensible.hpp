#pragma once

#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

/// Edges that keep their lengths, in place of stretch. An augmented Lagrangian (Nocedal and Wright
/// 2006, Sect. 17.3): a stiff spring holds an edge, and where the energy is at a minimum, the force
/// it holds is remembered as the edge's tension, until no edge of the rod is longer or shorter by
/// more than a part of 1e-6.
///
/// Forces add up along a hanging rod: of n edges, springs n² as stiff as the inertia of a node
/// leave a part of the lengths' error that does not depend on n.
class Inextensible : public Effect {
 public:
  explicit Inextensible(const Rods& rods);

  void begin_step(Rods& rods, const TimeStep& step) override;
  bool is_stored() const override { return false; }

  std::uint32_t values_per_node() const override { return 2; }
  const double* values_of(std::uint32_t node) const override;
  void energy(const RodPack& rods, const std::vector<SimdBatch>& values,
              SimdBatch& energy) const override;
  void add_derivatives(const RodPack& rods, const std::vector<SimdBatch>& values,
                       PackSystem& system) const override;

  bool has_multipliers() const override { return true; }
  bool update_multipliers(const Rods& rods, std::uint32_t rod) override;
  void add_forces(const RodPack& rods, const std::vector<SimdBatch>& values,
                  RodForces& forces) const override;

  /// Tension of an edge; negative under pressure [N].
  double tension(std::uint32_t edge) const { return springs_[edge].tension; }

 private:
  /// As the energy reads it.
  struct Spring {
    double tension = 0.0;    // [N]
    double stiffness = 0.0;  // in this step [N/m]
  };

  double force(const Rods& rods, std::uint32_t edge) const;

  std::vector<Spring> springs_;  // of edges
};

}  // namespace fiber
