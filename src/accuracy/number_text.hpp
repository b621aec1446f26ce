#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

namespace fiber {

/// A number with this many digits that count, and whole from where it has as many before the point.
inline std::string rounded_text(double value, int digits = 2) {
  std::array<char, 40> text{};
  const double size = std::abs(value);
  const bool is_whole = size >= std::pow(10.0, digits) - 0.5 && size < 1e6;
  if (is_whole) {
    std::snprintf(text.data(), text.size(), "%.0f", value);
  } else {
    std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  }
  return text.data();
}

/// A length in millimetres, as people who set up a cable think of it: 0.001 becomes "1 mm".
/// @param length [m]
inline std::string millimetres(double length) { return rounded_text(1e3 * length) + " mm"; }

}  // namespace fiber
