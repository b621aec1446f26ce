#pragma once

#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

/// Internal friction of a Kelvin–Voigt material: each stiffness resists the rate of its strain as
/// well, with a relaxation time. Rigid motion is not damped, but for a bent rod's turning about its
/// own tangents: cross-sections are taken not to turn about them. Nor is a fold, which has no
/// direction.
class Damping : public Effect {
 public:
  /// @param relaxation_time of stretch and bend [s]
  /// @throws std::invalid_argument if it is negative or not finite
  explicit Damping(double relaxation_time);

  void begin_step(Rods& rods, const TimeStep& step) override;
  double energy(const Rods& rods, std::uint32_t rod) const override;
  void add_derivatives(const Rods& rods, std::uint32_t rod, RodSystem& system) const override;

 private:
  double relaxation_time_;
  double share_ = 0.0;  // of a stiffness that resists what a step changes

  // When the step began:
  std::vector<double> lengths_;           // of edges [m]
  std::vector<Eigen::Vector3d> turns_;    // at nodes
  std::vector<Eigen::Vector3d> middles_;  // of the tangents beside the nodes, not normalised
};

}  // namespace fiber
