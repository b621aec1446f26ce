// The distance of two segments, rounded to the nearest double, and whether it is within a limit,
// mostly without integers: the robust kernel tells which points are nearest, numbers of twice the
// digits give the distance, and bounds on their error prove the answer. docs/numerics.md has the
// bounds.
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <optional>

#include "fiber_proximity/geometry/segment_distance.hpp"
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

/// Two end points that are `offset` apart are nearest if the distance grows along both segments.
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

/// An end point and a line are nearest if its foot is inside the segment and the distance grows
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

/// Points of two lines are nearest if both feet are inside.
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

const DoubleDouble zero(0.0);
const DoubleDouble one(1.0);

/// A part of coordinates and limit: all results here err by less (docs/numerics.md).
constexpr double roundings = 0x1p-94;

/// A parameter of a segment: from 0 to 1, also where the quotient is not a number.
DoubleDouble parameter(DoubleDouble numerator, DoubleDouble denominator) {
  if (!(zero < numerator)) {
    return zero;
  }
  return numerator < denominator ? numerator / denominator : one;
}

/// The vectors from one segment to the other: of two of their points, and across a plane between.
struct WideNearest {
  DoubleDoubleVector between;
  DoubleDoubleVector normal;
};

/// The points that are nearest if the robust ones are of the right kind: ends, or insides.
/// @param corners [i][j] from end j of q to end i of p
WideNearest wide_nearest_of(const SegmentDistance& robust,
                            const DoubleDoubleVector (&corners)[2][2], const DoubleDoubleVector& u,
                            const DoubleDoubleVector& v) {
  const bool on_p = robust.s > 0.0 && robust.s < 1.0;
  const bool on_q = robust.t > 0.0 && robust.t < 1.0;
  const std::size_t i = robust.s == 1.0 ? 1 : 0;
  const std::size_t j = robust.t == 1.0 ? 1 : 0;
  if (on_p && on_q) {
    const DoubleDoubleVector& w = corners[0][0];
    const DoubleDoubleVector normal = cross(u, v);
    const DoubleDouble squared = dot(normal, normal);
    const DoubleDouble s = parameter(dot(cross(v, w), normal), squared);
    const DoubleDouble t = parameter(dot(cross(u, w), normal), squared);
    const DoubleDoubleVector between = w + s * u + -t * v;
    return {between, dot(normal, between) < zero ? -normal : normal};
  }
  DoubleDoubleVector between = corners[i][j];
  if (on_p) {
    between = corners[0][j] + parameter(-dot(corners[0][j], u), dot(u, u)) * u;
  } else if (on_q) {
    between = corners[i][0] + -parameter(dot(corners[i][0], v), dot(v, v)) * v;
  }
  return {between, between};
}

/// Neither overflow nor underflow that counts.
bool is_in_range(double extent) { return extent > 0x1p-100 && extent < 0x1p100; }
constexpr double min_squared_normal = 0x1p-600;

/// gap_at_most() in numbers of twice the digits: whether there are two points that are surely no
/// further apart than the limit, or a plane that surely keeps the segments further apart. Nothing
/// where these do not tell, as of distances that are within a part of about 2⁻⁹⁴ of the limit.
/// @param robust tells where the nearest points are; what is proven does not depend on it
std::optional<bool> wide_gap_at_most(const SegmentDistance& robust, const Vector3d& p0,
                                     const Vector3d& p1, const Vector3d& q0, const Vector3d& q1,
                                     const ContactLimit& limit) {
  const double extent = robust.error / robust_error;
  const double parts = limit.parts();
  if (!is_in_range(extent) || !std::isfinite(parts)) {
    return std::nullopt;
  }
  const DoubleDoubleVector corners[2][2] = {{exact_difference(p0, q0), exact_difference(p0, q1)},
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
  if (!(squared_normal.high > min_squared_normal)) {
    return std::nullopt;
  }
  const DoubleDouble reach = root(squared_normal) * (sum + error);
  for (const auto& row : corners) {
    for (const DoubleDoubleVector& corner : row) {
      if (!(reach < dot(nearest.normal, corner))) {
        return std::nullopt;
      }
    }
  }
  return false;
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

bool gap_at_most(const SegmentDistance& robust, const Vector3d& p0, const Vector3d& p1,
                 const Vector3d& q0, const Vector3d& q1, const ContactLimit& limit) {
  // The proven error of the robust distance, and the rounding of sum and difference here.
  const double error = proven_robust_error_per_error * robust.error + 0x1p-50 * limit.parts() +
                       std::numeric_limits<double>::min();
  const double gap = robust.distance - limit.sum();
  if (std::abs(gap) > error + 0x1p-51 * robust.distance) {
    return gap < 0.0;
  }
  const std::optional<bool> wide = wide_gap_at_most(robust, p0, p1, q0, q1, limit);
  return wide ? *wide : exact_gap_at_most(p0, p1, q0, q1, limit);
}

bool gap_at_most(const Vector3d& p0, const Vector3d& p1, const Vector3d& q0, const Vector3d& q1,
                 const ContactLimit& limit) {
  return gap_at_most(segment_distance(p0, p1, q0, q1), p0, p1, q0, q1, limit);
}

}  // namespace fiber
