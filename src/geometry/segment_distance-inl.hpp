// The nearest points of segments, one pair per lane. Included once per instruction set, so it has
// the guard that Highway asks for instead of #pragma once; for one lane see geometry/lanes.hpp.
#if defined(FIBER_SEGMENT_DISTANCE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FIBER_SEGMENT_DISTANCE_INL
#undef FIBER_SEGMENT_DISTANCE_INL
#else
#define FIBER_SEGMENT_DISTANCE_INL
#endif

#include "src/geometry/lanes.hpp"

FIBER_LANES_BEGIN

/// The algorithm of segment_distance() in as many lanes of double or float as D has. Every
/// operation is rounded on its own, in the same order for any D: no multiplication is fused with an
/// addition, so all instruction sets and numbers of lanes give the same bits.
template <class D>
class LaneDistance {
 public:
  using V = hn::Vec<D>;

  struct Vector {
    V x;
    V y;
    V z;
  };

  /// Differences of the four end points; all that the distance depends on [m].
  struct Differences {
    Vector u;    // p1 − p0
    Vector v;    // q1 − q0
    Vector w;    // p0 − q0
    Vector w_u;  // p1 − q0
    Vector w_v;  // p0 − q1
  };

  FIBER_LANE_MEMBER static Vector subtract(const Vector& a, const Vector& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
  }

  /// Largest difference of coordinates along one axis, of all four points.
  FIBER_LANE_MEMBER static V extent(const Vector& p0, const Vector& p1, const Vector& q0,
                                    const Vector& q1) {
    return hn::Max(extent(p0.x, p1.x, q0.x, q1.x),
                   hn::Max(extent(p0.y, p1.y, q0.y, q1.y), extent(p0.z, p1.z, q0.z, q1.z)));
  }

  /// Best candidate so far.
  V s;
  V t;
  Vector delta;  // from q's point to p's point [m]
  V squared;     // |delta|² [m²]

  FIBER_LANE_MEMBER explicit LaneDistance(const Differences& d) {
    const V zero = hn::Zero(D());
    const V one = hn::Set(D(), hn::TFromD<D>(1));
    const V uu = dot(d.u, d.u);
    const V vv = dot(d.v, d.v);
    s = zero;  // p0 on q
    t = project(d.w, d.v, vv);
    delta = subtract(d.w, scaled(t, d.v));
    squared = dot(delta, delta);

    const V t_p1 = project(d.w_u, d.v, vv);
    consider(one, t_p1, subtract(d.w_u, scaled(t_p1, d.v)));
    const V s_q0 = project(negative(d.w), d.u, uu);
    consider(s_q0, zero, add(d.w, scaled(s_q0, d.u)));
    const V s_q1 = project(negative(d.w_v), d.u, uu);
    consider(s_q1, one, add(d.w_v, scaled(s_q1, d.u)));

    const Vector normal = cross(d.u, d.v);
    const V denominator = dot(normal, normal);
    const V numerator = dot(cross(d.v, d.w), normal);
    const auto inside = hn::And(hn::Gt(numerator, zero), hn::Lt(numerator, denominator));
    // Elsewhere this considers p0 again, which is not closer than itself.
    const V s_inside = hn::IfThenElseZero(inside, hn::Div(numerator, denominator));
    const Vector on_p = add(d.w, scaled(s_inside, d.u));
    const V t_inside = project(on_p, d.v, vv);
    consider(s_inside, t_inside, subtract(on_p, scaled(t_inside, d.v)));
  }

 private:
  FIBER_LANE_MEMBER static V extent(V p0, V p1, V q0, V q1) {
    return hn::Sub(hn::Max(hn::Max(p0, p1), hn::Max(q0, q1)),
                   hn::Min(hn::Min(p0, p1), hn::Min(q0, q1)));
  }
  FIBER_LANE_MEMBER static Vector add(const Vector& a, const Vector& b) {
    return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
  }
  FIBER_LANE_MEMBER static Vector negative(const Vector& a) {
    return {hn::Neg(a.x), hn::Neg(a.y), hn::Neg(a.z)};
  }
  FIBER_LANE_MEMBER static Vector scaled(V factor, const Vector& a) {
    return {hn::Mul(factor, a.x), hn::Mul(factor, a.y), hn::Mul(factor, a.z)};
  }
  FIBER_LANE_MEMBER static V dot(const Vector& a, const Vector& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
  }
  FIBER_LANE_MEMBER static Vector cross(const Vector& a, const Vector& b) {
    return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
            hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
            hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
  }

  /// Parameter in [0, 1] of the projection of a point at `offset` from a segment's start; 0 on a
  /// segment of no length.
  FIBER_LANE_MEMBER static V project(const Vector& offset, const Vector& direction,
                                     V squared_length) {
    const V along = dot(offset, direction);
    const V parameter =
        hn::IfThenElse(hn::Lt(along, squared_length), hn::Div(along, squared_length),
                       hn::Set(D(), hn::TFromD<D>(1)));
    return hn::IfThenElseZero(hn::Gt(along, hn::Zero(D())), parameter);
  }

  FIBER_LANE_MEMBER void consider(V other_s, V other_t, const Vector& other_delta) {
    const V other_squared = dot(other_delta, other_delta);
    const auto closer = hn::Lt(other_squared, squared);
    s = hn::IfThenElse(closer, other_s, s);
    t = hn::IfThenElse(closer, other_t, t);
    delta.x = hn::IfThenElse(closer, other_delta.x, delta.x);
    delta.y = hn::IfThenElse(closer, other_delta.y, delta.y);
    delta.z = hn::IfThenElse(closer, other_delta.z, delta.z);
    squared = hn::IfThenElse(closer, other_squared, squared);
  }
};

FIBER_LANES_END
#endif
