#pragma once

#include <cmath>

namespace fiber {

/// A sum of energies, and of their magnitudes, which rounding errors are a part of [J].
struct Merit {
  double energy = 0.0;
  double magnitude = 0.0;

  void add(double part) {
    energy += part;
    magnitude += std::abs(part);
  }
  void add(const Merit& part) {
    energy += part.energy;
    magnitude += part.magnitude;
  }

  /// A step that changes less than the last digits cannot be judged by them: small motion of a rod
  /// under large stress would come to rest.
  double unseen() const { return 1e-12 * magnitude; }
};

}  // namespace fiber
