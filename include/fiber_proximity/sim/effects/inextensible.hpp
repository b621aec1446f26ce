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
  void end_solve(const Rods& rods, std::uint32_t rod) override;
  void end_step(Rods& rods, const TimeStep& step) override;

  /// Tension of an edge; negative under pressure [N].
  double tension(std::uint32_t edge) const { return tensions_[edge]; }

 private:
  double force(const Rods& rods, std::uint32_t edge, double length) const;

  std::vector<double> tensions_;     // of edges [N]
  std::vector<double> found_;        // in this step [N]
  std::vector<double> stiffnesses_;  // of their springs in this step [N/m]
};

}  // namespace fiber
