#pragma once

#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

/// Edges that keep their lengths, in place of stretch. An augmented Lagrangian (Nocedal and Wright
/// 2006, Sect. 17.3): a stiff spring holds an edge in the step, and what it has to hold is
/// remembered as the edge's tension, so that the spring need not be stretched in the next.
class Inextensible : public Effect {
 public:
  explicit Inextensible(const Rods& rods);

  void begin_step(Rods& rods, const TimeStep& step) override;
  double energy(const Rods& rods, std::uint32_t rod) const override;
  double stored_energy(const Rods& /*rods*/, std::uint32_t /*rod*/) const override { return 0.0; }
  void add_derivatives(const Rods& rods, std::uint32_t rod, RodSystem& system) const override;

  bool works_in_lanes(const Rods& /*rods*/) const override { return true; }
  std::uint32_t values_per_node() const override { return 2; }
  const double* values_of(std::uint32_t node) const override;
  void energy_in_lanes(const RodLanes& rods, const std::vector<Lanes>& values,
                       Lanes& energy) const override;
  void add_derivatives_in_lanes(const RodLanes& rods, const std::vector<Lanes>& values,
                                LaneSystem& system) const override;

  void end_solve(const Rods& rods, std::uint32_t rod) override;
  void end_step(Rods& rods, const TimeStep& step) override;

  /// Tension of an edge; negative under pressure [N].
  double tension(std::uint32_t edge) const { return springs_[edge].tension; }

 private:
  /// As functions in lanes read it.
  struct Spring {
    double tension = 0.0;    // [N]
    double stiffness = 0.0;  // in this step [N/m]
  };

  double force(const Rods& rods, std::uint32_t edge, double length) const;

  std::vector<Spring> springs_;  // of edges
  std::vector<double> found_;    // tensions, in this step [N]
};

}  // namespace fiber
