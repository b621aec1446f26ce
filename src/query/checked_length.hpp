#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

namespace fiber {

/// An engine's option [m], if it is finite and not negative.
/// @throws std::invalid_argument naming it otherwise
inline double checked_length(const std::string& name, double length) {
  if (!(length >= 0.0 && std::isfinite(length))) {
    throw std::invalid_argument(name + " is " + std::to_string(length) +
                                " m, it must be finite and not negative");
  }
  return length;
}

}  // namespace fiber
