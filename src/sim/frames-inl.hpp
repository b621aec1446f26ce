// Frames of edges side by side, as effects/twist.hpp has them of one. Included once per instruction
// set, as lanes-inl.hpp is.
#if defined(FIBER_SIM_FRAMES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FIBER_SIM_FRAMES_INL
#undef FIBER_SIM_FRAMES_INL
#else
#define FIBER_SIM_FRAMES_INL
#endif

#include <hwy/highway.h>

#include <cmath>

#include "src/sim/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {

HWY_INLINE Vector cross(const Vector& a, const Vector& b) {
  return {{a.of[1] * b.of[2] - a.of[2] * b.of[1], a.of[2] * b.of[0] - a.of[0] * b.of[2],
           a.of[0] * b.of[1] - a.of[1] * b.of[0]}};
}

HWY_INLINE Vector transport(const Vector& v, const Vector& from, const Vector& to) {
  const Real cosine = dot(from, to);
  const Real beside_opposite = real(1.0) + cosine;
  const Vector axis = cross(from, to);
  const Vector turned = cosine * v + cross(axis, v) + dot(axis, v) / beside_opposite * axis;
  const auto is_opposite = hn::Lt(beside_opposite.value, real(1e-12).value);
  Vector result;
  for (std::size_t k = 0; k < 3; ++k) {
    result.of[k] = {hn::IfThenElse(is_opposite, v.of[k].value, turned.of[k].value)};
  }
  return result;
}

HWY_INLINE Vector curvature_binormal(const Vector& before, const Vector& after) {
  constexpr double folded = 1e-3;
  const Real factor = real(2.0) / larger(real(folded), real(1.0) + dot(before, after));
  return factor * cross(before, after);
}

HWY_INLINE Real nearest_turn(Real angle, Real to) {
  const Real turn = real(2.0 * M_PI);
  return angle - turn * Real{hn::Round(((angle - to) / turn).value)};
}

HWY_INLINE Real angle_at(const RodLanes& rods, std::size_t edge, std::size_t lane) {
  return load(rods.positions[4 * edge + 3], lane);
}

HWY_INLINE Vector director_turn(const RodLanes& rods, std::size_t edge, std::size_t lane) {
  const Vector start = load_vector(&rods.start_tangents[3 * edge], lane);
  return real(-0.5) * load(rods.inverse_lengths[edge], lane) *
         curvature_binormal(start, tangent_at(rods, edge, lane));
}

}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
