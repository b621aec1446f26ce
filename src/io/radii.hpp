#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/io/number.hpp"

namespace fiber {

/// A default radius that a caller gives for files without radii.
/// @throws std::invalid_argument naming the value and what is allowed
inline void check_default_radius(double radius) {
  if (!FiberAssembly::is_valid_radius(radius)) {
    throw std::invalid_argument("the default radius is " + text_of(radius) + ", " +
                                FiberAssembly::radius_rule);
  }
}

/// One radius where it serves all points: the cheap form of an assembly.
inline std::vector<double> shared_if_equal(std::vector<double> radii) {
  for (const double radius : radii) {
    if (radius != radii.front()) {
      return radii;
    }
  }
  radii.resize(1);
  return radii;
}

}  // namespace fiber
