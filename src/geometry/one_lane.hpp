#pragma once

#include <cmath>
#include <cstddef>

/// Marks what runs on a GPU as well, where CUDA's compiler reads it.
#ifdef __CUDACC__
#define FIBER_ON_DEVICE __host__ __device__
#else
#define FIBER_ON_DEVICE
#endif

/// Highway's functions, by their names, for one lane that is a number. No comparison with NaN is
/// true, as there; the least and the largest are of numbers only.
namespace fiber::one_lane {

namespace hn = ::fiber::one_lane;

template <class T>
struct Tag {
  using Number = T;
};
template <class T, std::size_t>
using CappedTag = Tag<T>;
template <class D>
using TFromD = typename D::Number;
template <class D>
using Vec = typename D::Number;
template <class D>
using Mask = bool;

// NOLINTBEGIN(readability-identifier-naming): Highway's
template <class D, class T>
FIBER_ON_DEVICE typename D::Number Set(D /*tag*/, T value) {
  return static_cast<typename D::Number>(value);
}
template <class D>
FIBER_ON_DEVICE typename D::Number Zero(D /*tag*/) {
  return 0;
}

// clang-format off
template <class T> FIBER_ON_DEVICE T Add(T a, T b) { return a + b; }
template <class T> FIBER_ON_DEVICE T Sub(T a, T b) { return a - b; }
template <class T> FIBER_ON_DEVICE T Mul(T a, T b) { return a * b; }
template <class T> FIBER_ON_DEVICE T Div(T a, T b) { return a / b; }
template <class T> FIBER_ON_DEVICE T MulAdd(T a, T b, T c) { return a * b + c; }
template <class T> FIBER_ON_DEVICE T MulSub(T a, T b, T c) { return a * b - c; }
template <class T> FIBER_ON_DEVICE T Neg(T a) { return -a; }
template <class T> FIBER_ON_DEVICE T Abs(T a) { return std::fabs(a); }
template <class T> FIBER_ON_DEVICE T Min(T a, T b) { return a < b ? a : b; }
template <class T> FIBER_ON_DEVICE T Max(T a, T b) { return a > b ? a : b; }
template <class T> FIBER_ON_DEVICE T Sqrt(T a) { return sqrt(a); }
template <class T> FIBER_ON_DEVICE bool Lt(T a, T b) { return a < b; }
template <class T> FIBER_ON_DEVICE bool Le(T a, T b) { return a <= b; }
template <class T> FIBER_ON_DEVICE bool Gt(T a, T b) { return a > b; }
template <class T> FIBER_ON_DEVICE bool Ge(T a, T b) { return a >= b; }
FIBER_ON_DEVICE inline bool And(bool a, bool b) { return a && b; }
FIBER_ON_DEVICE inline bool Or(bool a, bool b) { return a || b; }
FIBER_ON_DEVICE inline bool Not(bool a) { return !a; }
template <class T> FIBER_ON_DEVICE T IfThenElse(bool which, T a, T b) { return which ? a : b; }
template <class T> FIBER_ON_DEVICE T IfThenElseZero(bool which, T a) { return which ? a : T(0); }
// clang-format on
// NOLINTEND(readability-identifier-naming)

}  // namespace fiber::one_lane
