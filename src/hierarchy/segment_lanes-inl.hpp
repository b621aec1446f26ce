// The segments of runs in the lanes of a register. Included once per instruction set, so it has the
// guard that Highway asks for instead of #pragma once.
#if defined(FIBER_SEGMENT_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FIBER_SEGMENT_LANES_INL
#undef FIBER_SEGMENT_LANES_INL
#else
#define FIBER_SEGMENT_LANES_INL
#endif

#include <hwy/highway.h>

#include "src/hierarchy/run_tree_kernels.hpp"
#include "src/hierarchy/segment_tests-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {

static_assert(max_lanes == run_width, "the lanes of a register hold a run");

HWY_INLINE Lanes load(const float (&values)[run_width], std::size_t lane) {
  return hn::Load(Floats(), values + lane);
}
HWY_INLINE LaneVector load(const float (&by_axis)[3][run_width], std::size_t lane) {
  return {load(by_axis[0], lane), load(by_axis[1], lane), load(by_axis[2], lane)};
}
HWY_INLINE void store(const LaneVector& vectors, float (&by_axis)[3][run_width], std::size_t lane) {
  const Floats d;
  hn::Store(vectors.x, d, by_axis[0] + lane);
  hn::Store(vectors.y, d, by_axis[1] + lane);
  hn::Store(vectors.z, d, by_axis[2] + lane);
}
/// One vector in all lanes.
HWY_INLINE LaneVector spread(const float (&by_axis)[3][run_width], std::uint32_t lane) {
  const Floats d;
  return {hn::Set(d, by_axis[0][lane]), hn::Set(d, by_axis[1][lane]), hn::Set(d, by_axis[2][lane])};
}

HWY_INLINE std::uint32_t bits_of(LaneMask mask) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(Floats(), mask, bits);
  return bits[0];
}

}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();
#endif
