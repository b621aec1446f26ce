// A test of the distance of segments that never misses, one pair per lane. Included once per
// instruction set, so it has the guard that Highway asks for instead of #pragma once; for one lane
// see geometry/lanes.hpp.
#if defined(FIBER_SEGMENT_TESTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FIBER_SEGMENT_TESTS_INL
#undef FIBER_SEGMENT_TESTS_INL
#else
#define FIBER_SEGMENT_TESTS_INL
#endif

#include <cstddef>
#include <limits>

#include "src/geometry/lanes.hpp"

FIBER_LANES_BEGIN

/// Rounding a point, and all that the tests of this file do with it, errs by less than
/// 32 u of the largest coordinate, u = 2⁻²⁴; the constant keeps it alive where floats run out [m].
constexpr float relative_padding = 0x1p-19F;
constexpr float min_padding = 0x1p-60F;

/// At most eight lanes, fewer where the machine has no more.
constexpr std::size_t max_lanes = 8;
using Floats = hn::CappedTag<float, max_lanes>;
using Lanes = hn::Vec<Floats>;
using LaneMask = hn::Mask<Floats>;

struct LaneVector {
  Lanes x;
  Lanes y;
  Lanes z;
};

FIBER_LANE_INLINE LaneVector add(const LaneVector& a, const LaneVector& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
FIBER_LANE_INLINE LaneVector subtract(const LaneVector& a, const LaneVector& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
FIBER_LANE_INLINE LaneVector negative(const LaneVector& a) {
  return {hn::Neg(a.x), hn::Neg(a.y), hn::Neg(a.z)};
}
FIBER_LANE_INLINE LaneVector absolute(const LaneVector& a) {
  return {hn::Abs(a.x), hn::Abs(a.y), hn::Abs(a.z)};
}
FIBER_LANE_INLINE LaneVector minimum(const LaneVector& a, const LaneVector& b) {
  return {hn::Min(a.x, b.x), hn::Min(a.y, b.y), hn::Min(a.z, b.z)};
}
FIBER_LANE_INLINE LaneVector maximum(const LaneVector& a, const LaneVector& b) {
  return {hn::Max(a.x, b.x), hn::Max(a.y, b.y), hn::Max(a.z, b.z)};
}
FIBER_LANE_INLINE Lanes dot(const LaneVector& a, const LaneVector& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
FIBER_LANE_INLINE LaneVector cross(const LaneVector& a, const LaneVector& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}
/// |x| + |y| + |z|, at least the length.
FIBER_LANE_INLINE Lanes length_bound(const LaneVector& a) {
  return hn::Add(hn::Abs(a.x), hn::Add(hn::Abs(a.y), hn::Abs(a.z)));
}
/// offset + factor · direction
FIBER_LANE_INLINE LaneVector along(const LaneVector& offset, Lanes factor,
                                   const LaneVector& direction) {
  return {hn::MulAdd(factor, direction.x, offset.x), hn::MulAdd(factor, direction.y, offset.y),
          hn::MulAdd(factor, direction.z, offset.z)};
}

/// Corners of the boxes around segments with these radii.
FIBER_LANE_INLINE LaneVector lower_corner(const LaneVector& start, const LaneVector& end,
                                          Lanes radius) {
  return subtract(minimum(start, end), {radius, radius, radius});
}
FIBER_LANE_INLINE LaneVector upper_corner(const LaneVector& start, const LaneVector& end,
                                          Lanes radius) {
  return add(maximum(start, end), {radius, radius, radius});
}

FIBER_LANE_INLINE LaneMask boxes_overlap(const LaneVector& lower_a, const LaneVector& upper_a,
                                         const LaneVector& lower_b, const LaneVector& upper_b) {
  return hn::And(hn::And(hn::And(hn::Le(lower_a.x, upper_b.x), hn::Le(lower_b.x, upper_a.x)),
                         hn::And(hn::Le(lower_a.y, upper_b.y), hn::Le(lower_b.y, upper_a.y))),
                 hn::And(hn::Le(lower_a.z, upper_b.z), hn::Le(lower_b.z, upper_a.z)));
}

/// One segment per lane.
struct LaneSegments {
  LaneVector start;
  LaneVector direction;          // end − start [m]
  Lanes inverse_squared_length;  // [1/m²], finite even for segments of no length
};

FIBER_LANE_INLINE LaneSegments lane_segments(const LaneVector& start, const LaneVector& end) {
  const Floats d;
  const LaneVector direction = subtract(end, start);
  const auto least = hn::Set(d, std::numeric_limits<float>::min());
  return {start, direction, hn::Div(hn::Set(d, 1.0F), hn::Max(dot(direction, direction), least))};
}

/// Squared distance of a segment from the point at `offset` from its start [m²]. Whatever the
/// rounding of the parameter, the point it gives is on the segment: the error is one of rounding
/// coordinates, not of conditioning.
FIBER_LANE_INLINE Lanes squared_distance_to(const LaneSegments& segment, const LaneVector& offset) {
  const Floats d;
  const auto parameter = hn::Min(
      hn::Max(hn::Mul(dot(offset, segment.direction), segment.inverse_squared_length), hn::Zero(d)),
      hn::Set(d, 1.0F));
  const LaneVector nearest = along(offset, hn::Neg(parameter), segment.direction);
  return dot(nearest, nearest);
}

// Two segments come within `reach` of each other if an end point of one comes within reach of the
// other, which is well conditioned, or if the nearest points are inside both. Then their distance
// is that of the lines, |w·n|/|n| with n = u×v, and s = (v×w)·n/|n|² and t = (u×w)·n/|n|² are in
// [0, 1]. These three are compared without division, each with a bound of its rounding error:
// products of l₁ norms times 32 u, where no expression here rounds by more than 20 u of them. Where
// such a product overflows, so does the bound, and nothing is told apart. Beyond that, rounding is
// covered by the padding of the radii.

constexpr float rounding_of_products = 0x1p-19F;

/// Below this sum of l₁ norms no product of two overflows [m].
constexpr float largest_extent = 0x1p60F;

/// Whether a gap, times the length of n, is within the reach: true too often, never too seldom.
FIBER_LANE_INLINE LaneMask within_reach(Lanes gap, Lanes reach, const LaneVector& n) {
  const Floats d;
  const auto least = hn::Max(gap, hn::Zero(d));
  const auto limit = hn::Mul(hn::Mul(reach, reach), dot(n, n));
  return hn::Not(
      hn::Gt(hn::Mul(least, least), hn::MulAdd(limit, hn::Set(d, 1.0F + rounding_of_products),
                                               hn::Set(d, std::numeric_limits<float>::min()))));
}

/// Whether the lines of segments in directions u and v, whose starts are w apart, may come within
/// `reach`: true too often, never too seldom. Most segments with boxes that overlap are told apart
/// by this, at a third of the cost of all.
FIBER_LANE_INLINE LaneMask lines_near(const LaneVector& u, const LaneVector& v, const LaneVector& w,
                                      Lanes reach) {
  const Floats d;
  const LaneVector n = cross(u, v);
  const auto rounding =
      hn::Mul(hn::Set(d, rounding_of_products),
              hn::Mul(length_bound(w), hn::Mul(length_bound(u), length_bound(v))));
  return within_reach(hn::Sub(hn::Abs(dot(w, n)), rounding), reach, n);
}

/// Whether two segments whose lines come within `reach` may do so, too: true too often, never too
/// seldom.
FIBER_LANE_INLINE LaneMask segments_near(const LaneSegments& a, const LaneSegments& b,
                                         Lanes reach) {
  const Floats d;
  const auto tiny = hn::Set(d, std::numeric_limits<float>::min());
  const LaneVector& u = a.direction;
  const LaneVector& v = b.direction;
  const LaneVector w = subtract(a.start, b.start);
  const LaneVector minus_w = subtract(b.start, a.start);

  const auto ends_on_b = hn::Min(squared_distance_to(b, w), squared_distance_to(b, add(w, u)));
  const auto ends_on_a =
      hn::Min(squared_distance_to(a, minus_w), squared_distance_to(a, add(minus_w, v)));
  const auto ends_apart = hn::Gt(hn::Min(ends_on_a, ends_on_b), hn::MulAdd(reach, reach, tiny));

  const LaneVector n = cross(u, v);
  const auto nn = dot(n, n);
  const auto length_u = length_bound(u);
  const auto length_v = length_bound(v);
  const auto length_w = length_bound(w);
  const auto product = hn::Mul(length_u, length_v);
  const auto rounding = hn::Set(d, rounding_of_products);
  const auto s = dot(cross(v, w), n);
  const auto t = dot(cross(u, w), n);
  const auto slack_s =
      hn::MulAdd(rounding, hn::Mul(hn::Mul(product, length_v), hn::Add(length_w, length_u)), tiny);
  const auto slack_t =
      hn::MulAdd(rounding, hn::Mul(hn::Mul(product, length_u), hn::Add(length_w, length_v)), tiny);
  const auto outside = hn::Or(hn::Or(hn::Gt(hn::Neg(s), slack_s), hn::Gt(s, hn::Add(nn, slack_s))),
                              hn::Or(hn::Gt(hn::Neg(t), slack_t), hn::Gt(t, hn::Add(nn, slack_t))));
  const auto is_in_range =
      hn::Lt(hn::Add(length_w, hn::Add(length_u, length_v)), hn::Set(d, largest_extent));
  return hn::Not(hn::And(hn::And(ends_apart, outside), is_in_range));
}

FIBER_LANES_END
#endif
