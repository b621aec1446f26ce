#pragma once

#include <cmath>

namespace fiber {

/// The natural logarithm of a positive, finite number, to some units of the last digit: unlike the
/// standard library's the same on all processors.
inline double natural_log(double x) {
  constexpr double root_of_half = 0.7071067811865476;
  constexpr double log_of_two = 0.6931471805599453;
  int exponent = 0;
  double fraction = std::frexp(x, &exponent);  // in [1/2, 1)
  if (fraction < root_of_half) {
    fraction *= 2.0;
    --exponent;
  }
  // ln f = 2 artanh z, of |z| < 0.172
  const double z = (fraction - 1.0) / (fraction + 1.0);
  const double square = z * z;
  double series = 0.0;
  for (int power = 21; power > 0; power -= 2) {
    series = 1.0 / power + square * series;
  }
  return exponent * log_of_two + 2.0 * z * series;
}

}  // namespace fiber
