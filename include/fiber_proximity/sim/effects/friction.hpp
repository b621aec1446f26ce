#pragma once

#include <Eigen/Core>

namespace fiber {

/// Coulomb friction in contacts, as a potential of one step (Li et al. 2020, Sect. 5): with normal
/// forces and contact planes as they are when the step begins, and smooth about sticking. With the
/// largest force f and the slip y that the stick speed brings in a step, the force is
/// f (2 y/e − y²/e²) for slips y below e, and f above.
class Friction {
 public:
  /// The law of Coulomb, smoothed.
  struct Options {
    double coefficient = 0.3;    ///< of friction; >= 0
    double stick_speed = 0.001;  ///< [m/s] what sticks creeps more slowly; > 0
  };

  /// @throws std::invalid_argument naming the value that is out of its range
  explicit Friction(const Options& options);

  double coefficient() const { return options_.coefficient; }

  /// @param step [s]
  /// @returns the slip below which a contact sticks [m]
  double stick_length(double step) const { return options_.stick_speed * step; }

  /// Of a slip y, per newton of the largest force, with the stick length e; all lengths in [m].
  struct Law {
    double energy;      ///< [m]
    double resistance;  ///< force divided by the slip [1/m]
    double curvature;   ///< of the energy along the slip, never below 0 [1/m]
  };
  static Law law(double slip, double stick_length);

 private:
  Options options_;
};

}  // namespace fiber
