#pragma once

#include <memory>

#include "fiber_proximity/sim/stepper.hpp"

namespace fiber {

/// A rod across a slope, at rest, with `twist`: the slope goes down along x, and z is its normal.
class RodOnSlope {
 public:
  /// @param angle    [rad]
  /// @param radius   [m]
  /// @param friction coefficient
  RodOnSlope(double angle, double radius, double friction, Integrator integrator);

  /// @param time [s]
  void run(double time) const;

  /// Of the whole rod, downwards [m/s].
  double speed() const;

  /// Of all sections, in the sense in which the rod rolls downwards [rad/s].
  double mean_spin() const;

 private:
  std::unique_ptr<Stepper> stepper_;
};

}  // namespace fiber
