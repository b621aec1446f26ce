#pragma once

#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

/// Rods that stay bent: where the curvature differs from the natural one by more than the material
/// bears, the natural one follows after each step (return mapping, Simo and Hughes 1998, Sect. 1.4,
/// in one dimension). Like the natural curvatures of Bend, what stays has no direction.
class Plasticity : public Effect {
 public:
  /// When bending lasts.
  struct Options {
    double yield_strain = 0.02;  ///< of the outermost fibre, where yielding begins; > 0
    double hardening = 0.0;      ///< share of what exceeds that and stays elastic, in [0, 1)
  };

  /// Adds Rods::natural_curvatures if there are none.
  /// @throws std::invalid_argument naming the value that is out of its range, or for rods with
  ///         natural curvature vectors
  Plasticity(Rods& rods, const Options& options);

  void end_step(Rods& rods, const TimeStep& step) override;

 private:
  Options options_;
};

}  // namespace fiber
