#include "src/geometry/exact_numbers.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>

namespace fiber {
namespace {

constexpr int precision = std::numeric_limits<double>::digits;
constexpr int min_exponent = std::numeric_limits<double>::min_exponent - precision;  // −1074

int bit_length(const Integer& value) {
  return value == 0 ? 0 : static_cast<int>(boost::multiprecision::msb(value)) + 1;
}

/// (value + a part of 1 that is not 0 if there is a rest) · 2^exponent to the nearest double, ties
/// to even; value has more bits than a double, or no rest. Not negative.
Rounded rounded(const Integer& value, bool has_rest, int exponent) {
  const int drop =
      std::max(bit_length(value) - precision, min_exponent - exponent);  // bits too many
  if (drop <= 0) {
    assert(!has_rest);
    return {std::ldexp(value.convert_to<double>(), exponent), true};
  }
  const Integer kept = value >> drop;
  const Integer dropped = value - (kept << drop);
  const Integer half = Integer(1) << (drop - 1);
  auto mantissa = kept.convert_to<std::uint64_t>();  // fits: of at most 53 bits
  if (dropped > half || (dropped == half && (has_rest || (mantissa & 1U) != 0))) {
    ++mantissa;
  }
  return {std::ldexp(static_cast<double>(mantissa), exponent + drop), dropped == 0 && !has_rest};
}

}  // namespace

int last_bit(double value) {
  if (value == 0.0) {
    return std::numeric_limits<int>::max();
  }
  int exponent = 0;
  const double mantissa = std::frexp(std::abs(value), &exponent);
  auto bits = static_cast<std::uint64_t>(std::ldexp(mantissa, precision));
  exponent -= precision;
  for (; (bits & 1U) == 0; bits >>= 1U) {
    ++exponent;
  }
  return exponent;
}

Integer scaled_integer(double value, int exponent) {
  if (value == 0.0) {
    return 0;
  }
  const int last = last_bit(value);
  assert(exponent <= last);
  return Integer(static_cast<std::int64_t>(std::ldexp(value, -last))) << (last - exponent);
}

int last_bit(std::initializer_list<Eigen::Vector3d> vectors) {
  int exponent = std::numeric_limits<int>::max();
  for (const Eigen::Vector3d& vector : vectors) {
    for (const double coordinate : {vector.x(), vector.y(), vector.z()}) {
      exponent = std::min(exponent, last_bit(coordinate));
    }
  }
  return exponent;
}

IntegerVector scaled_integers(const Eigen::Vector3d& vector, int exponent) {
  return {scaled_integer(vector.x(), exponent), scaled_integer(vector.y(), exponent),
          scaled_integer(vector.z(), exponent)};
}

Rounded rounded_quotient(const Integer& numerator, const Integer& denominator, int exponent) {
  assert(denominator > 0);
  const Integer magnitude = abs(numerator);
  // Two bits more than a double has, so that what is dropped never hides a tie.
  const int shift = std::max(0, precision + 2 - (bit_length(magnitude) - bit_length(denominator)));
  Integer quotient;
  Integer rest;
  divide_qr(Integer(magnitude << shift), denominator, quotient, rest);
  Rounded result = rounded(quotient, rest != 0, exponent - shift);
  result.value = numerator < 0 ? -result.value : result.value;
  return result;
}

Rounded rounded_root(const Integer& squared, const Integer& denominator, int exponent) {
  assert(squared >= 0 && denominator > 0);
  // √squared / denominator = √(squared / denominator²), with an even shift for the root to halve.
  const Integer divisor = denominator * denominator;
  const int wanted = 2 * (precision + 2) - (bit_length(squared) - bit_length(divisor));
  const int shift = wanted > 0 ? wanted + (wanted & 1) : 0;
  Integer quotient;
  Integer rest;
  divide_qr(Integer(squared << shift), divisor, quotient, rest);
  Integer root_rest;
  const Integer root = sqrt(quotient, root_rest);
  return rounded(root, rest != 0 || root_rest != 0, exponent - shift / 2);
}

}  // namespace fiber
