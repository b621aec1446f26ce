#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <boost/multiprecision/gmp.hpp>

namespace fiber::test {

using Rational = boost::multiprecision::mpq_rational;
/// 330 bits and a wide exponent: a square root of an exact rational, far below any error we test.
using Wide = boost::multiprecision::mpf_float_100;
using ExactVector = std::array<Rational, 3>;

inline ExactVector exact(const Eigen::Vector3d& v) {
  return {Rational(v.x()), Rational(v.y()), Rational(v.z())};
}
inline ExactVector add_scaled(const ExactVector& a, const Rational& factor, const ExactVector& b) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}
inline Rational dot(const ExactVector& a, const ExactVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline bool is_interior(const Rational& parameter) { return parameter > 0 && parameter < 1; }

/// Exact squared distance of a point from a segment.
inline Rational squared_distance(const ExactVector& point, const ExactVector& start,
                                 const ExactVector& end) {
  const ExactVector direction = add_scaled(end, -1, start);
  const ExactVector offset = add_scaled(point, -1, start);
  const Rational length = dot(direction, direction);
  Rational t = length == 0 ? Rational(0) : Rational(dot(offset, direction) / length);
  t = t < 0 ? Rational(0) : (t > 1 ? Rational(1) : t);
  const ExactVector delta = add_scaled(offset, -t, direction);
  return dot(delta, delta);
}

/// Exact squared distance of two segments: in rationals, by the textbook's normal equations, so
/// that it shares neither arithmetic nor formula with the kernel under test.
inline Rational exact_squared_distance(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                                       const Eigen::Vector3d& q0, const Eigen::Vector3d& q1) {
  const ExactVector a0 = exact(p0);
  const ExactVector a1 = exact(p1);
  const ExactVector b0 = exact(q0);
  const ExactVector b1 = exact(q1);
  Rational best = squared_distance(a0, b0, b1);
  for (const Rational& other :
       {squared_distance(a1, b0, b1), squared_distance(b0, a0, a1), squared_distance(b1, a0, a1)}) {
    best = other < best ? other : best;
  }
  const ExactVector u = add_scaled(a1, -1, a0);
  const ExactVector v = add_scaled(b1, -1, b0);
  const ExactVector w = add_scaled(a0, -1, b0);
  const Rational a = dot(u, u);
  const Rational b = dot(u, v);
  const Rational c = dot(v, v);
  const Rational determinant = a * c - b * b;
  if (determinant > 0) {
    const Rational s = (b * dot(v, w) - c * dot(u, w)) / determinant;
    const Rational t = (a * dot(v, w) - b * dot(u, w)) / determinant;
    if (is_interior(s) && is_interior(t)) {
      const ExactVector delta = add_scaled(add_scaled(w, s, u), -t, v);
      best = dot(delta, delta);
    }
  }
  return best;
}

inline Wide exact_distance(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                           const Eigen::Vector3d& q0, const Eigen::Vector3d& q1) {
  const Rational squared = exact_squared_distance(p0, p1, q0, q1);
  return sqrt(Wide(numerator(squared)) / Wide(denominator(squared)));
}

}  // namespace fiber::test
