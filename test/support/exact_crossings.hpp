#pragma once

#include <optional>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/crossings.hpp"
#include "test/support/exact_distance.hpp"
#include "test/support/exact_pairs.hpp"

namespace fiber::test {

/// A crossing in rationals.
struct ExactCrossing {
  Key key;
  Rational s;
  Rational t;
  bool a_is_over = false;
  int sign = 0;
};

inline Rational determinant(const ExactVector& a, const ExactVector& b, const ExactVector& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

inline ExactVector difference(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return add_scaled(exact(a), -1, exact(b));
}

/// Of two segments in general position, from the linear equations of the ray that meets both axes:
/// no orientations, so that it shares no formula with the test under test.
inline std::optional<ExactCrossing> exact_crossing(const Capsule& a, const Capsule& b,
                                                   const View& view) {
  const ExactVector u = difference(a.p1, a.p0);
  const ExactVector v = difference(b.p1, b.p0);
  const ExactVector d = exact(view.direction);
  const ExactVector w = difference(b.p0, a.p0);
  ExactCrossing crossing;
  if (view.is_perspective) {
    // (a0 − e) + s u = k ((b0 − e) + t v), in s, k and k t.
    const ExactVector a0 = difference(a.p0, view.eye);
    const ExactVector b0 = difference(b.p0, view.eye);
    const Rational whole = determinant(u, b0, v);
    if (whole == 0) {
      return std::nullopt;
    }
    crossing.s = -determinant(a0, b0, v) / whole;
    const Rational k = determinant(u, a0, v) / whole;
    if (k <= 0 || dot(add_scaled(a0, crossing.s, u), d) <= 0) {
      return std::nullopt;
    }
    crossing.t = determinant(u, b0, a0) / whole / k;
    crossing.a_is_over = k < 1;
  } else {
    // a0 + s u + k d = b0 + t v.
    const Rational whole = determinant(u, v, d);
    if (whole == 0) {
      return std::nullopt;
    }
    crossing.s = determinant(w, v, d) / whole;
    crossing.t = -determinant(u, w, d) / whole;
    crossing.a_is_over = determinant(u, v, w) / whole > 0;
  }
  if (!is_interior(crossing.s) || !is_interior(crossing.t)) {
    return std::nullopt;
  }
  crossing.sign = determinant(u, v, w) < 0 ? 1 : -1;
  return crossing;
}

/// Of all pairs of segments that are no neighbours by index.
inline std::vector<ExactCrossing> exact_crossings(const FiberAssembly& fibers, const View& view) {
  std::vector<ExactCrossing> crossings;
  const std::vector<std::uint32_t> segments = segments_of(fibers);
  for (const std::uint32_t a : segments) {
    for (const std::uint32_t b : segments) {
      const SegmentId id_a = fibers.segment_id(a);
      const SegmentId id_b = fibers.segment_id(b);
      if (a >= b || (id_a.fiber == id_b.fiber && b - a <= 1)) {
        continue;
      }
      if (auto crossing = exact_crossing(fibers.capsule(a), fibers.capsule(b), view)) {
        crossing->key = {id_a.fiber, id_a.segment, id_b.fiber, id_b.segment};
        crossings.push_back(*crossing);
      }
    }
  }
  return crossings;
}

}  // namespace fiber::test
