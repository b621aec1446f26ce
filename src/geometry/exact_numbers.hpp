#pragma once

#include <Eigen/Core>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <initializer_list>

namespace fiber {

/// As large as it takes. No expression templates: with them `auto` would hold references.
using Integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>,
                                              boost::multiprecision::et_off>;
using IntegerVector = std::array<Integer, 3>;

inline IntegerVector operator-(const IntegerVector& a, const IntegerVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline IntegerVector operator+(const IntegerVector& a, const IntegerVector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline IntegerVector operator*(const Integer& factor, const IntegerVector& a) {
  return {factor * a[0], factor * a[1], factor * a[2]};
}
inline Integer dot(const IntegerVector& a, const IntegerVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline IntegerVector cross(const IntegerVector& a, const IntegerVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The exponent of the last bit of a finite number that is set; of 0 the largest int.
int last_bit(double value);

/// value · 2^−exponent, exactly; the exponent is at most last_bit(value).
Integer scaled_integer(double value, int exponent);

/// The least exponent of the last bits of all coordinates; the largest int if all are 0.
int last_bit(std::initializer_list<Eigen::Vector3d> vectors);

/// Scales each coordinate as scaled_integer() does.
IntegerVector scaled_integers(const Eigen::Vector3d& vector, int exponent);

/// A double and whether it is exact.
struct Rounded {
  double value = 0.0;
  bool exact = true;
};

/// numerator / denominator · 2^exponent to the nearest double; denominator > 0.
Rounded rounded_quotient(const Integer& numerator, const Integer& denominator, int exponent);

/// √squared / denominator · 2^exponent to the nearest double; squared >= 0, denominator > 0.
Rounded rounded_root(const Integer& squared, const Integer& denominator, int exponent);

}  // namespace fiber
