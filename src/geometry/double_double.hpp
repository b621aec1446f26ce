#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

namespace fiber {

/// A number of about 106 bits: the sum of two doubles, of which the second is the rounding error of
/// the first. Operations err by less than 2⁻¹⁰² of their result (Joldes, Muller and Popescu 2017,
/// Tight and rigorous error bounds for basic building blocks of double-word arithmetic), as long as
/// nothing overflows or underflows.
struct DoubleDouble {
  double high = 0.0;
  double low = 0.0;

  DoubleDouble() = default;
  explicit DoubleDouble(double value) : high(value) {}
  DoubleDouble(double high_part, double low_part) : high(high_part), low(low_part) {}

  explicit operator double() const { return high; }
};

inline bool operator<(DoubleDouble a, DoubleDouble b) {
  return a.high < b.high || (a.high == b.high && a.low < b.low);
}

/// Exactly a + b, of any a and b.
inline DoubleDouble exact_sum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

/// Exactly a + b, where |a| >= |b|.
inline DoubleDouble exact_ordered_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// Exactly a · b.
inline DoubleDouble exact_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

inline DoubleDouble operator-(DoubleDouble a) { return {-a.high, -a.low}; }

inline DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble high = exact_sum(a.high, b.high);
  const DoubleDouble low = exact_sum(a.low, b.low);
  const DoubleDouble sum = exact_ordered_sum(high.high, high.low + low.high);
  return exact_ordered_sum(sum.high, sum.low + low.low);
}

inline DoubleDouble operator-(DoubleDouble a, DoubleDouble b) { return a + -b; }

inline DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble high = exact_product(a.high, b.high);
  const double low = std::fma(a.high, b.low, a.low * b.high);
  return exact_ordered_sum(high.high, high.low + low);
}

inline DoubleDouble operator/(DoubleDouble a, DoubleDouble b) {
  const double first = a.high / b.high;
  const DoubleDouble rest = a - b * DoubleDouble(first);
  const double second = rest.high / b.high;
  const DoubleDouble last = rest - b * DoubleDouble(second);
  return exact_ordered_sum(first, second) + DoubleDouble(last.high / b.high);
}

/// Square root of a number above 0.
inline DoubleDouble root(DoubleDouble a) {
  const double first = std::sqrt(a.high);
  const DoubleDouble rest = a - exact_product(first, first);
  return exact_ordered_sum(first, 0.5 * rest.high / first);
}

using DoubleDoubleVector = std::array<DoubleDouble, 3>;

/// Exactly a − b.
inline DoubleDoubleVector exact_difference(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {exact_sum(a.x(), -b.x()), exact_sum(a.y(), -b.y()), exact_sum(a.z(), -b.z())};
}

inline DoubleDouble dot(const DoubleDoubleVector& a, const DoubleDoubleVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline DoubleDoubleVector cross(const DoubleDoubleVector& a, const DoubleDoubleVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline DoubleDoubleVector operator+(const DoubleDoubleVector& a, const DoubleDoubleVector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline DoubleDoubleVector operator*(DoubleDouble factor, const DoubleDoubleVector& a) {
  return {factor * a[0], factor * a[1], factor * a[2]};
}
inline DoubleDoubleVector operator-(const DoubleDoubleVector& a) { return {-a[0], -a[1], -a[2]}; }

/// Rounded to double.
inline Eigen::Vector3d rounded(const DoubleDoubleVector& a) {
  return {a[0].high, a[1].high, a[2].high};
}

}  // namespace fiber
