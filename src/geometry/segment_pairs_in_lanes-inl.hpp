// Pairs of segments between memory and the lanes of registers. Included once per instruction set,
// so it has the guard that Highway asks for instead of #pragma once.
#if defined(FIBER_SEGMENT_PAIRS_IN_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FIBER_SEGMENT_PAIRS_IN_LANES_INL
#undef FIBER_SEGMENT_PAIRS_IN_LANES_INL
#else
#define FIBER_SEGMENT_PAIRS_IN_LANES_INL
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "src/geometry/segment_distance-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {

/// Ends of as many segments as Lanes has lanes, coordinate by coordinate.
template <class Lanes>
struct alignas(64) SegmentEnds {
  static constexpr std::size_t coordinates = 6;

  double values[coordinates][hn::MaxLanes(Lanes())];

  /// @param count from 1 to the number of lanes; those beyond it hold the last segment, too
  HWY_INLINE SegmentEnds(const Eigen::Vector3d* const* starts, std::size_t count) {
    for (std::size_t lane = 0; lane < hn::Lanes(Lanes()); ++lane) {
      const double* const from = starts[std::min(lane, count - 1)]->data();
      for (std::size_t i = 0; i < coordinates; ++i) {
        values[i][lane] = from[i];
      }
    }
  }

  /// The first ends (0) or the second ones (1): of as many lanes as D has, from this one.
  template <class D>
  HWY_INLINE typename LaneDistance<D>::Vector points(D d, std::size_t which,
                                                     std::size_t lane = 0) const {
    return {hn::Load(d, values[3 * which] + lane), hn::Load(d, values[3 * which + 1] + lane),
            hn::Load(d, values[3 * which + 2] + lane)};
  }
};

/// Nearest points of the lanes, one kind of value after the other.
template <class D>
struct alignas(64) LaneResults {
  hn::TFromD<D> values[6][hn::MaxLanes(D())];

  HWY_INLINE explicit LaneResults(const LaneDistance<D>& nearest) {
    const D d;
    hn::Store(nearest.s, d, values[0]);
    hn::Store(nearest.t, d, values[1]);
    hn::Store(hn::Neg(nearest.delta.x), d, values[2]);
    hn::Store(hn::Neg(nearest.delta.y), d, values[3]);
    hn::Store(hn::Neg(nearest.delta.z), d, values[4]);
    hn::Store(hn::Sqrt(nearest.squared), d, values[5]);
  }

  /// @param error [m]
  HWY_INLINE SegmentDistance of(std::size_t lane, double error) const {
    return {values[0][lane],
            values[1][lane],
            {values[2][lane], values[3][lane], values[4][lane]},
            values[5][lane],
            error};
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();
#endif
