// The distance of two segments, rounded to the nearest double, mostly without integers: the robust
// kernel tells which points are nearest, signs with bounds prove it, numbers of twice the digits
// give the distance, and a bound on their error proves how it is rounded. docs/numerics.md has the
// bounds.
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <optional>

#include "fiber_proximity/geometry/exact_distance.hpp"
#include "src/geometry/double_double.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

constexpr double half_ulp = 0x1p-53;

/// A distance of twice the digits, and its relative error.
struct WideDistance {
  DoubleDouble value;
  double error;
};

/// A dot product and the sum of its terms' magnitudes, of vectors of which each coordinate is
/// rounded once: it is off by less than eight half ulps of that sum.
struct Dot {
  double value;
  double magnitude;

  Dot(const Vector3d& a, const Vector3d& b)
      : value(a.dot(b)), magnitude(a.cwiseAbs().dot(b.cwiseAbs())) {}

  bool is_surely_positive() const { return value > 8.0 * half_ulp * magnitude; }
};

/// Of two end points that are `offset` apart: nearest if the distance grows along both segments.
/// @param u, v from these ends to the others'
std::optional<WideDistance> between_ends(const DoubleDoubleVector& offset, const Vector3d& u,
                                         const Vector3d& v) {
  const Vector3d rounded_offset = rounded(offset);
  if (!Dot(u, rounded_offset).is_surely_positive() ||
      !Dot(-v, rounded_offset).is_surely_positive()) {
    return std::nullopt;
  }
  return WideDistance{root(dot(offset, offset)), 0x1p-98};
}

/// Of an end point and a line: nearest if its foot is inside the segment and the distance grows
/// along the segment the end is of.
/// @param offset from the line's start to the end point
/// @param line   the segment the foot is on
/// @param own    from the end point to the other one of its segment
std::optional<WideDistance> to_line(const DoubleDoubleVector& offset,
                                    const DoubleDoubleVector& line, const Vector3d& own) {
  const Vector3d o = rounded(offset);
  const Vector3d v = rounded(line);
  const Dot along(o, v);
  const Dot length(v, v);
  const double error = 8.0 * half_ulp * along.magnitude;
  if (!(along.value > error && length.value * (1.0 - 16.0 * half_ulp) - along.value > error)) {
    return std::nullopt;
  }
  // The derivative along `own`, times the squared length of the line.
  const Dot from_start(own, o);
  const Dot across(own, v);
  const double derivative = from_start.value * length.value - along.value * across.value;
  const double magnitude = from_start.magnitude * length.value + along.magnitude * across.magnitude;
  if (!(derivative > 32.0 * half_ulp * magnitude)) {
    return std::nullopt;
  }
  const DoubleDoubleVector normal = cross(offset, line);
  const DoubleDouble distance = root(dot(normal, normal) / dot(line, line));
  return WideDistance{distance, 0x1p-98 * (1.0 + o.norm() / distance.high)};
}

/// Of two lines: nearest if both feet are inside.
/// @param w from the start of v to the start of u
std::optional<WideDistance> between_lines(const DoubleDoubleVector& u, const DoubleDoubleVector& v,
                                          const DoubleDoubleVector& w) {
  const Vector3d ru = rounded(u);
  const Vector3d rv = rounded(v);
  const Vector3d rw = rounded(w);
  const Vector3d normal = ru.cross(rv);
  const double lengths = ru.norm() * rv.norm();
  const double denominator = normal.squaredNorm();
  const double denominator_error =
      32.0 * half_ulp * lengths * (std::sqrt(denominator) + 8.0 * half_ulp * lengths);
  const double s = rv.cross(rw).dot(normal);
  const double t = ru.cross(rw).dot(normal);
  const double s_error = 32.0 * half_ulp * lengths * rv.norm() * rw.norm();
  const double t_error = 32.0 * half_ulp * lengths * ru.norm() * rw.norm();
  if (!(s > s_error && denominator - s > s_error + denominator_error && t > t_error &&
        denominator - t > t_error + denominator_error)) {
    return std::nullopt;
  }
  const DoubleDoubleVector wide_normal = cross(u, v);
  const DoubleDouble volume = dot(w, wide_normal);
  const DoubleDouble squared = dot(wide_normal, wide_normal);
  const DoubleDouble distance = root(volume * volume / squared);
  const double spread = lengths / std::sqrt(squared.high);
  return WideDistance{distance, 0x1p-98 * (1.0 + spread) * (1.0 + rw.norm() / distance.high)};
}

std::optional<WideDistance> wide_distance(const SegmentDistance& robust, const Vector3d& p0,
                                          const Vector3d& p1, const Vector3d& q0,
                                          const Vector3d& q1) {
  const bool p_end = robust.s == 0.0 || robust.s == 1.0;
  const bool q_end = robust.t == 0.0 || robust.t == 1.0;
  const Vector3d& p = robust.s == 1.0 ? p1 : p0;
  const Vector3d& q = robust.t == 1.0 ? q1 : q0;
  const Vector3d from_p = robust.s == 1.0 ? Vector3d(p0 - p1) : Vector3d(p1 - p0);
  const Vector3d from_q = robust.t == 1.0 ? Vector3d(q0 - q1) : Vector3d(q1 - q0);
  if (p_end && q_end) {
    return between_ends(exact_difference(p, q), from_p, from_q);
  }
  if (p_end) {
    return to_line(exact_difference(p, q0), exact_difference(q1, q0), from_p);
  }
  if (q_end) {
    return to_line(exact_difference(q, p0), exact_difference(p1, p0), from_q);
  }
  return between_lines(exact_difference(p1, p0), exact_difference(q1, q0),
                       exact_difference(p0, q0));
}

/// Neither overflow nor underflow anywhere above.
bool is_in_range(const SegmentDistance& robust, const Vector3d& u, const Vector3d& v) {
  constexpr double least = 0x1p-100;
  constexpr double largest = 0x1p100;
  const double extent = robust.error / robust_error;
  return extent < largest && robust.distance > least && u.squaredNorm() > least * least &&
         v.squaredNorm() > least * least;
}

}  // namespace

SegmentDistance rounded_segment_distance(const SegmentDistance& robust, const Vector3d& p0,
                                         const Vector3d& p1, const Vector3d& q0,
                                         const Vector3d& q1) {
  if (is_in_range(robust, p1 - p0, q1 - q0)) {
    if (const auto wide = wide_distance(robust, p0, p1, q0, q1)) {
      const auto [high, low] = wide->value;
      const double error = wide->error * high;
      if (high + (low + error) == high && high + (low - error) == high) {
        SegmentDistance result = robust;
        result.distance = high;
        result.error = std::nextafter(high, std::numeric_limits<double>::infinity()) - high;
        return result;
      }
    }
  }
  return exact_segment_distance(p0, p1, q0, q1);
}

}  // namespace fiber
