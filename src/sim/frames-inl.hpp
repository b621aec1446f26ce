// Frames of edges side by side, as effects/twist.hpp has them of one. Included once per instruction
// set, as simd-inl.hpp is.
#if defined(FIBER_SIM_FRAMES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FIBER_SIM_FRAMES_INL
#undef FIBER_SIM_FRAMES_INL
#else
#define FIBER_SIM_FRAMES_INL
#endif

#include <hwy/highway.h>

#include <cmath>
#include <limits>

#include "src/sim/simd-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {

HWY_INLINE Vector cross(const Vector& a, const Vector& b) {
  return {{a.of[1] * b.of[2] - a.of[2] * b.of[1], a.of[2] * b.of[0] - a.of[0] * b.of[2],
           a.of[0] * b.of[1] - a.of[1] * b.of[0]}};
}

HWY_INLINE Vector transport(const Vector& v, const Vector& from, const Vector& to) {
  const Real cosine = dot(from, to);
  const Vector sum = from + to;
  const Real beside_opposite = real(0.5) * dot(sum, sum);
  const Vector axis = cross(from, to);
  const Vector turned = cosine * v + cross(axis, v) + dot(axis, v) / beside_opposite * axis;
  const auto stays = hn::Or(hn::Lt(beside_opposite.value, real(1e-12).value),
                            hn::Eq((dot(from, from) * dot(to, to)).value, real(0.0).value));
  Vector result;
  for (std::size_t k = 0; k < 3; ++k) {
    result.of[k] = {hn::IfThenElse(stays, v.of[k].value, turned.of[k].value)};
  }
  return result;
}

HWY_INLINE Vector curvature_binormal(const Vector& before, const Vector& after) {
  constexpr double folded = 1e-3;
  const Real factor = real(2.0) / larger(real(folded), real(1.0) + dot(before, after));
  return factor * cross(before, after);
}

/// In [-pi, pi]. Neither Highway nor the standard library has an arctangent that is the same on all
/// processors; this one is wrong by some units of the last digit.
HWY_INLINE Real angle_of(Real cosine, Real sine) {
  const Real one = real(1.0);
  const Real least = real(std::numeric_limits<double>::min());
  const Real across = {hn::Abs(sine.value)};
  const Real along = {hn::Abs(cosine.value)};
  // The tangent of an angle of up to pi/4, and of a quarter of it, whose series is short.
  Real tangent = smaller(across, along) / larger(larger(across, along), least);
  for (int i = 0; i < 2; ++i) {
    tangent = tangent / (one + square_root(one + tangent * tangent));
  }
  const Real square = tangent * tangent;
  Real series = real(0.0);
  for (int power = 21; power > 0; power -= 2) {
    series = real(1.0 / power) - square * series;
  }
  const Real angle = real(4.0) * tangent * series;
  const auto is_steep = hn::Gt(across.value, along.value);
  const Real in_quadrant = {
      hn::IfThenElse(is_steep, (real(0.5 * M_PI) - angle).value, angle.value)};
  const auto is_behind = hn::Lt(cosine.value, real(0.0).value);
  const Real in_half = {
      hn::IfThenElse(is_behind, (real(M_PI) - in_quadrant).value, in_quadrant.value)};
  return {hn::CopySignToAbs(in_half.value, sine.value)};
}

HWY_INLINE Real signed_angle(const Vector& from, const Vector& to, const Vector& about) {
  return angle_of(dot(from, to), dot(about, cross(from, to)));
}

HWY_INLINE Real nearest_turn(Real angle, Real to) {
  const Real turn = real(2.0 * M_PI);
  return angle - turn * Real{hn::Round(((angle - to) / turn).value)};
}

HWY_INLINE Real angle_at(const RodPack& rods, std::size_t edge, std::size_t lane) {
  return load(rods.positions[4 * edge + 3], lane);
}

HWY_INLINE Vector director_turn(const RodPack& rods, std::size_t edge, std::size_t lane) {
  const Vector start = load_vector(&rods.start_tangents[3 * edge], lane);
  return real(-0.5) * load(rods.inverse_lengths[edge], lane) *
         curvature_binormal(start, tangent_at(rods, edge, lane));
}

}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
