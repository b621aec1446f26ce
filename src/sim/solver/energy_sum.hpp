#pragma once

#include <cmath>

namespace fiber {

/// A sum of energies, and of their magnitudes, which rounding errors are a part of [J].
struct EnergySum {
  double energy = 0.0;
  double magnitude = 0.0;

  void add(double part) {
    energy += part;
    magnitude += std::abs(part);
  }
  void add(const EnergySum& part) {
    energy += part.energy;
    magnitude += part.magnitude;
  }

  /// What rounding errors may be [J]: a step that changes less cannot be judged by its energy.
  double roundoff() const { return 1e-13 * magnitude; }
};

}  // namespace fiber
