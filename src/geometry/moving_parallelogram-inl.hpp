// Vectors of any kind of number (of doubles in lanes, of double, of twice its digits), those from
// one moving segment to another, and a plane that keeps them away from the origin. Included once
// per instruction set, so it has the guard that Highway asks for instead of #pragma once.
#if defined(FIBER_MOVING_PARALLELOGRAM_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FIBER_MOVING_PARALLELOGRAM_INL
#undef FIBER_MOVING_PARALLELOGRAM_INL
#else
#define FIBER_MOVING_PARALLELOGRAM_INL
#endif

#include <hwy/highway.h>

#include <cmath>

#include "src/geometry/double_double.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// As many doubles as a register has lanes, with the operators of a number. Each is rounded on its
/// own, as a double is: no multiplication is fused with an addition.
struct LaneNumber {
  using Tag = hn::CappedTag<double, 8>;
  using Mask = hn::Mask<Tag>;

  hn::Vec<Tag> lanes;

  LaneNumber() = default;
  HWY_INLINE explicit LaneNumber(hn::Vec<Tag> all) : lanes(all) {}
  HWY_INLINE explicit LaneNumber(double value) : lanes(hn::Set(Tag(), value)) {}
};

HWY_INLINE LaneNumber operator+(LaneNumber a, LaneNumber b) {
  return LaneNumber(hn::Add(a.lanes, b.lanes));
}
HWY_INLINE LaneNumber operator-(LaneNumber a, LaneNumber b) {
  return LaneNumber(hn::Sub(a.lanes, b.lanes));
}
HWY_INLINE LaneNumber operator*(LaneNumber a, LaneNumber b) {
  return LaneNumber(hn::Mul(a.lanes, b.lanes));
}
HWY_INLINE LaneNumber operator/(LaneNumber a, LaneNumber b) {
  return LaneNumber(hn::Div(a.lanes, b.lanes));
}
HWY_INLINE LaneNumber operator-(LaneNumber a) { return LaneNumber(hn::Neg(a.lanes)); }
HWY_INLINE LaneNumber root_of(LaneNumber a) { return LaneNumber(hn::Sqrt(a.lanes)); }
HWY_INLINE LaneNumber::Mask operator<(LaneNumber a, LaneNumber b) {
  return hn::Lt(a.lanes, b.lanes);
}
HWY_INLINE LaneNumber::Mask both(LaneNumber::Mask a, LaneNumber::Mask b) { return hn::And(a, b); }
HWY_INLINE LaneNumber::Mask but_not(LaneNumber::Mask a, LaneNumber::Mask b) {
  return hn::AndNot(b, a);
}
HWY_INLINE LaneNumber choose(LaneNumber::Mask condition, LaneNumber yes, LaneNumber no) {
  return LaneNumber(hn::IfThenElse(condition, yes.lanes, no.lanes));
}

// These are their counterparts for numbers that stand alone.
inline double root_of(double a) { return std::sqrt(a); }
inline DoubleDouble root_of(DoubleDouble a) { return a.high == 0.0 ? a : root(a); }
inline bool both(bool a, bool b) { return a && b; }
inline bool but_not(bool a, bool b) { return a && !b; }
template <class Number>
Number choose(bool condition, const Number& yes, const Number& no) {
  return condition ? yes : no;
}

template <class Number>
struct NumberVector {
  Number x;
  Number y;
  Number z;
};

template <class Number>
HWY_INLINE NumberVector<Number> operator+(const NumberVector<Number>& a,
                                          const NumberVector<Number>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Number>
HWY_INLINE NumberVector<Number> operator-(const NumberVector<Number>& a,
                                          const NumberVector<Number>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Number>
HWY_INLINE NumberVector<Number> operator*(const Number& factor, const NumberVector<Number>& a) {
  return {factor * a.x, factor * a.y, factor * a.z};
}
template <class Number>
HWY_INLINE Number dot(const NumberVector<Number>& a, const NumberVector<Number>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Number>
HWY_INLINE NumberVector<Number> cross(const NumberVector<Number>& a,
                                      const NumberVector<Number>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Number>
HWY_INLINE Number length_of(const NumberVector<Number>& a) {
  return root_of(dot(a, a));
}
template <class Mask, class Number>
HWY_INLINE NumberVector<Number> choose_vector(const Mask& condition,
                                              const NumberVector<Number>& yes,
                                              const NumberVector<Number>& no) {
  return {choose(condition, yes.x, no.x), choose(condition, yes.y, no.y),
          choose(condition, yes.z, no.z)};
}

/// The smaller one; the second where one is not a number.
template <class Number>
HWY_INLINE Number smaller(const Number& a, const Number& b) {
  return choose(a < b, a, b);
}
template <class Number>
HWY_INLINE Number larger(const Number& a, const Number& b) {
  return choose(b < a, a, b);
}
template <class Number>
HWY_INLINE NumberVector<Number> smaller(const NumberVector<Number>& a,
                                        const NumberVector<Number>& b) {
  return {smaller(a.x, b.x), smaller(a.y, b.y), smaller(a.z, b.z)};
}
template <class Number>
HWY_INLINE NumberVector<Number> larger(const NumberVector<Number>& a,
                                       const NumberVector<Number>& b) {
  return {larger(a.x, b.x), larger(a.y, b.y), larger(a.z, b.z)};
}

/// The vectors from the points of a segment b to those of a segment a [m], or how fast they change
/// [m per motion]: corners[i][j] is that from end j of b to end i of a.
template <class Number>
struct Parallelogram {
  NumberVector<Number> corners[2][2];

  HWY_INLINE NumberVector<Number> along_a() const { return corners[1][0] - corners[0][0]; }
  HWY_INLINE NumberVector<Number> along_b() const { return corners[0][0] - corners[0][1]; }

  /// The vector between the points with these parameters.
  HWY_INLINE NumberVector<Number> between(const Number& s, const Number& t) const {
    const Number rest_s = Number(1.0) - s;
    const Number rest_t = Number(1.0) - t;
    return rest_s * (rest_t * corners[0][0] + t * corners[0][1]) +
           s * (rest_t * corners[1][0] + t * corners[1][1]);
  }
};

template <class Number>
HWY_INLINE Parallelogram<Number> moved(const Parallelogram<Number>& start,
                                       const Parallelogram<Number>& rate, const Number& time) {
  Parallelogram<Number> now;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      now.corners[i][j] = start.corners[i][j] + time * rate.corners[i][j];
    }
  }
  return now;
}

/// Two moving segments as they are at one time.
template <class Number>
struct MotionLook {
  Number distance;  ///< [m] of the two points
  Number closing;   ///< [m per motion] how fast they come nearer
  Number free;      ///< for so long there is no contact from here on
};

/// Later than any motion ends. Not infinite, of which numbers of twice the digits know nothing.
constexpr double never = 0x1p100;

/// The first h > 0 where a + b·h falls to 0, `never` if it does not; 0 if a is not positive, or if
/// something is not a number.
template <class Number>
HWY_INLINE Number first_root(const Number& a, const Number& b) {
  const Number zero(0.0);
  const Number result = choose(b < zero, a / -b, Number(never));
  return choose(both(zero < a, zero < result), result, zero);
}

/// The first root of a + b·h + c·h², likewise.
template <class Number>
HWY_INLINE Number first_root(const Number& a, const Number& b, const Number& c) {
  const Number zero(0.0);
  const Number discriminant = b * b - Number(4.0) * a * c;
  const auto has_none = discriminant < zero;
  const Number root = root_of(choose(has_none, zero, discriminant));
  // Neither difference cancels.
  const auto falls = b < zero;
  const Number quotient =
      choose(falls, a + a, b + root) / choose(falls, root - b, Number(-2.0) * c);
  const Number falling = choose(has_none, Number(never), quotient);
  const Number rising = choose(c < zero, quotient, Number(never));
  const Number result = choose(falls, falling, rising);
  return choose(both(zero < a, zero < result), result, zero);
}

/// A plane at right angles to a unit vector that turns at a constant rate: where it was, and where
/// it is turning to.
template <class Number>
struct TurningPlane {
  NumberVector<Number> normal;
  NumberVector<Number> turn;  ///< [1 per motion]
};

/// About the plane through the nearest points that follows the segments: at right angles to those
/// whose inside is nearest, now and a little later. Whatever it is, it is only a guess.
/// @param s, t of about the nearest points, 0 or 1 exactly at ends
template <class Number>
HWY_INLINE TurningPlane<Number> plane_between(const Parallelogram<Number>& now,
                                              const Parallelogram<Number>& rate, const Number& s,
                                              const Number& t,
                                              const NumberVector<Number>& nearest) {
  const Number zero(0.0);
  const Number one(1.0);
  // At smaller angles than this the nearest points serve better than the cross product.
  const Number min_sine_squared(1e-6);
  const NumberVector<Number> u = now.along_a();
  const NumberVector<Number> v = now.along_b();
  const NumberVector<Number> upright = cross(u, v);
  const Number uu = dot(u, u);
  const Number uv = dot(u, v);
  const Number vv = dot(v, v);
  const Number sine = dot(upright, upright);  // squared, times both squared lengths
  const auto on_a = both(zero < s, s < one);
  const auto on_b = both(zero < t, t < one);
  const auto on_both = both(both(on_a, on_b), min_sine_squared * (uu * vv) < sine);

  const NumberVector<Number> towards =
      choose_vector(dot(upright, nearest) < zero, Number(-1.0) * upright, upright);
  const Number part_a = choose(on_a, dot(nearest, u) / uu, zero);
  const NumberVector<Number> across_a = nearest - part_a * u;
  const Number part_b = choose(on_b, dot(across_a, v) / vv, zero);
  const NumberVector<Number> direction = choose_vector(on_both, towards, across_a - part_b * v);
  const NumberVector<Number> normal = (one / length_of(direction)) * direction;

  // To stay at right angles to a segment, the normal turns against what the segment turns out of
  // the plane.
  const Number out_a = dot(normal, rate.along_a());
  const Number out_b = dot(normal, rate.along_b());
  const auto of_a = both(on_a, zero < uu);
  const auto of_b = both(on_b, zero < vv);
  const Number turn_a = choose(on_both, out_b * uv - out_a * vv, choose(of_a, -out_a, zero)) /
                        choose(on_both, sine, choose(of_a, uu, one));
  const auto of_b_alone = but_not(of_b, of_a);
  const Number turn_b = choose(on_both, out_a * uv - out_b * uu, choose(of_b_alone, -out_b, zero)) /
                        choose(on_both, sine, choose(of_b_alone, vv, one));
  return {normal, turn_a * u + turn_b * v};
}

/// For how long the plane has all corners further beyond it than the limit.
/// @param limit [m]
/// @param error [m] of all that is computed here, for a turn by at most one radian
template <class Number>
HWY_INLINE Number free_time(const Parallelogram<Number>& now, const Parallelogram<Number>& rate,
                            const TurningPlane<Number>& plane, const Number& limit,
                            const Number& error) {
  const Number zero(0.0);
  const Number one(1.0);
  const Number turn = dot(plane.turn, plane.turn);
  // The normal changes its length as it turns: |n + h·m| is at most 1 + h·(n·m) + h²·m²/2.
  const Number growth = limit * dot(plane.normal, plane.turn);
  const Number growth_of_growth = Number(0.5) * limit * turn;
  Number standing(never);
  Number turning = one / root_of(turn);
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      const NumberVector<Number>& corner = now.corners[i][j];
      const NumberVector<Number>& speed = rate.corners[i][j];
      const Number beyond = dot(plane.normal, corner) - limit - error;
      const Number away = dot(plane.normal, speed);
      standing = smaller(first_root(beyond, away), standing);
      turning = smaller(first_root(beyond, away + dot(plane.turn, corner) - growth,
                                   dot(plane.turn, speed) - growth_of_growth),
                        turning);
    }
  }
  // The roots' own rounding.
  return Number(1.0 - 0x1p-50) * choose(standing < turning, turning, standing);
}

/// @param s, t of about the nearest points now; what is proven does not depend on them
template <class Number>
HWY_INLINE MotionLook<Number> look_at(const Parallelogram<Number>& now,
                                      const Parallelogram<Number>& rate, const Number& s,
                                      const Number& t, const Number& limit, const Number& error) {
  const NumberVector<Number> nearest = now.between(s, t);
  const TurningPlane<Number> plane = plane_between(now, rate, s, t, nearest);
  return {length_of(nearest), -dot(plane.normal, rate.between(s, t)),
          free_time(now, rate, plane, limit, error)};
}

}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();
#endif
