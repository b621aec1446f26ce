#include "src/geometry/wide_gap.hpp"

#include <cmath>

#include "src/geometry/double_double.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;
using Vector = DoubleDoubleVector;

const DoubleDouble zero(0.0);
const DoubleDouble one(1.0);

/// Of coordinates and limit: all that is computed here errs by less (docs/numerics.md).
constexpr double roundings = 0x1p-94;

Vector operator+(const Vector& a, const Vector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vector operator*(DoubleDouble factor, const Vector& a) {
  return {factor * a[0], factor * a[1], factor * a[2]};
}
Vector operator-(const Vector& a) { return {-a[0], -a[1], -a[2]}; }

/// A parameter of a segment: from 0 to 1, also where the quotient is not a number.
DoubleDouble parameter(DoubleDouble numerator, DoubleDouble denominator) {
  if (!(zero < numerator)) {
    return zero;
  }
  return numerator < denominator ? numerator / denominator : one;
}

/// The vectors from one segment to the other: of two of their points, and across a plane between.
struct WideNearest {
  Vector between;
  Vector normal;
};

/// Of the points that are nearest if the robust ones are of the right kind: ends, or insides.
/// @param corners [i][j] from end j of q to end i of p
WideNearest wide_nearest_of(const SegmentDistance& robust, const Vector (&corners)[2][2],
                            const Vector& u, const Vector& v) {
  const bool on_p = robust.s > 0.0 && robust.s < 1.0;
  const bool on_q = robust.t > 0.0 && robust.t < 1.0;
  const std::size_t i = robust.s == 1.0 ? 1 : 0;
  const std::size_t j = robust.t == 1.0 ? 1 : 0;
  if (on_p && on_q) {
    const Vector& w = corners[0][0];
    const Vector normal = cross(u, v);
    const DoubleDouble squared = dot(normal, normal);
    const DoubleDouble s = parameter(dot(cross(v, w), normal), squared);
    const DoubleDouble t = parameter(dot(cross(u, w), normal), squared);
    const Vector between = w + s * u + -t * v;
    return {between, dot(normal, between) < zero ? -normal : normal};
  }
  Vector between = corners[i][j];
  if (on_p) {
    between = corners[0][j] + parameter(-dot(corners[0][j], u), dot(u, u)) * u;
  } else if (on_q) {
    between = corners[i][0] + -parameter(dot(corners[i][0], v), dot(v, v)) * v;
  }
  return {between, between};
}

/// Neither overflow nor underflow that counts.
bool is_in_range(double extent) { return extent > 0x1p-100 && extent < 0x1p100; }
constexpr double least_squared_normal = 0x1p-600;

}  // namespace

std::optional<bool> wide_gap_at_most(const SegmentDistance& robust, const Vector3d& p0,
                                     const Vector3d& p1, const Vector3d& q0, const Vector3d& q1,
                                     const ContactLimit& limit) {
  const double extent = robust.error / robust_error;
  const double parts = limit.parts();
  if (!is_in_range(extent) || !std::isfinite(parts)) {
    return std::nullopt;
  }
  const Vector corners[2][2] = {{exact_difference(p0, q0), exact_difference(p0, q1)},
                                {exact_difference(p1, q0), exact_difference(p1, q1)}};
  const WideNearest nearest =
      wide_nearest_of(robust, corners, exact_difference(p1, p0), exact_difference(q1, q0));
  const auto sum = limit.sum<DoubleDouble>();
  const DoubleDouble error(roundings * (extent + parts));
  const DoubleDouble squared = dot(nearest.between, nearest.between);
  if (squared.high > 0.0 ? root(squared) < sum - error : zero < sum - error) {
    return true;
  }
  const DoubleDouble squared_normal = dot(nearest.normal, nearest.normal);
  if (!(squared_normal.high > least_squared_normal)) {
    return std::nullopt;
  }
  const DoubleDouble reach = root(squared_normal) * (sum + error);
  for (const auto& row : corners) {
    for (const Vector& corner : row) {
      if (!(reach < dot(nearest.normal, corner))) {
        return std::nullopt;
      }
    }
  }
  return false;
}

}  // namespace fiber
