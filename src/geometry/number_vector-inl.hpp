// Vectors of any kind of number: of doubles in lanes, of double, of twice its digits. Included once
// per instruction set, so it has the guard that Highway asks for instead of #pragma once.
#if defined(FIBER_NUMBER_VECTOR_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FIBER_NUMBER_VECTOR_INL
#undef FIBER_NUMBER_VECTOR_INL
#else
#define FIBER_NUMBER_VECTOR_INL
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

// The same of numbers that stand alone.
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

}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();
#endif
