#pragma once

#include <cstdint>
#include <cstring>
#include <limits>

namespace fiber {

/// The natural logarithm of a positive, finite number, to some units of the last digit: unlike the
/// standard library's the same on all processors. Without a call or a chain of eleven products, for
/// contacts ask for it all the time.
inline double natural_log(double x) {
  constexpr double root_of_half = 0.7071067811865476;
  constexpr double log_of_two = 0.6931471805599453;
  constexpr int mantissa_bits = 52;
  constexpr std::uint64_t mantissa = (std::uint64_t{1} << mantissa_bits) - 1;
  constexpr std::uint64_t half = std::uint64_t{0x3fe} << mantissa_bits;
  const bool is_subnormal = x < std::numeric_limits<double>::min();
  x *= is_subnormal ? 0x1p54 : 1.0;
  std::uint64_t bits = 0;
  std::memcpy(&bits, &x, sizeof bits);
  int exponent = static_cast<int>(bits >> mantissa_bits) - 0x3fe - (is_subnormal ? 54 : 0);
  bits = (bits & mantissa) | half;
  double fraction = 0.0;  // in [1/2, 1)
  std::memcpy(&fraction, &bits, sizeof fraction);
  if (fraction < root_of_half) {
    fraction *= 2.0;
    --exponent;
  }
  // ln f = 2 artanh z, of |z| < 0.172
  const double z = (fraction - 1.0) / (fraction + 1.0);
  const double z2 = z * z;
  const double z4 = z2 * z2;
  const double z8 = z4 * z4;
  const double first = (1.0 + z2 * (1.0 / 3.0)) + z4 * (1.0 / 5.0 + z2 * (1.0 / 7.0));
  const double second = (1.0 / 9.0 + z2 * (1.0 / 11.0)) + z4 * (1.0 / 13.0 + z2 * (1.0 / 15.0));
  const double third = (1.0 / 17.0 + z2 * (1.0 / 19.0)) + z4 * (1.0 / 21.0);
  return exponent * log_of_two + 2.0 * z * (first + z8 * (second + z8 * third));
}

}  // namespace fiber
