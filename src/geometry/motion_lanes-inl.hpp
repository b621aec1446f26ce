// Pairs of moving segments that are looked at together, one per lane. Included once per instruction
// set, so it has the guard that Highway asks for instead of #pragma once.
#if defined(FIBER_MOTION_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FIBER_MOTION_LANES_INL
#undef FIBER_MOTION_LANES_INL
#else
#define FIBER_MOTION_LANES_INL
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "src/geometry/segment_distance-inl.hpp"
#include "src/geometry/segment_motion-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {

using MotionTag = LaneNumber::Tag;

constexpr std::size_t most_motion_lanes = hn::MaxLanes(MotionTag());

/// What is computed in double errs by less than this part of coordinates and limit
/// (docs/numerics.md).
constexpr double motion_roundings = 0x1p-46;

HWY_INLINE Parallelogram<LaneNumber> load(const double (&values)[12][most_motion_lanes]) {
  const MotionTag d;
  Parallelogram<LaneNumber> result;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    result.corners[corner / 2][corner % 2] = {LaneNumber(hn::Load(d, values[3 * corner])),
                                              LaneNumber(hn::Load(d, values[3 * corner + 1])),
                                              LaneNumber(hn::Load(d, values[3 * corner + 2]))};
  }
  return result;
}

HWY_INLINE Parallelogram<LaneNumber> scaled(LaneNumber factor,
                                            const Parallelogram<LaneNumber>& shape) {
  Parallelogram<LaneNumber> result;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      result.corners[i][j] = factor * shape.corners[i][j];
    }
  }
  return result;
}

HWY_INLINE LaneDistance<MotionTag>::Vector lanes_of(const NumberVector<LaneNumber>& vector) {
  return {vector.x.lanes, vector.y.lanes, vector.z.lanes};
}

/// Looks at pairs where they are now.
HWY_INLINE MotionLook<LaneNumber> look_in_lanes(const Parallelogram<LaneNumber>& now,
                                                const Parallelogram<LaneNumber>& rate,
                                                LaneNumber limit, LaneNumber error) {
  const LaneDistance<MotionTag> nearest({lanes_of(now.along_a()), lanes_of(now.along_b()),
                                         lanes_of(now.corners[0][0]), lanes_of(now.corners[1][0]),
                                         lanes_of(now.corners[0][1])});
  return look_at(now, rate, LaneNumber(nearest.s), LaneNumber(nearest.t), limit, error);
}

/// What is looked at more closely, a pair a lane: coordinate by coordinate, then lane.
class alignas(64) LaneMotions {
 public:
  void set(std::size_t lane, const SegmentMotion<double>& motion) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      store(motion.start.corners[corner / 2][corner % 2], 3 * corner, lane, start_);
      store(motion.rate.corners[corner / 2][corner % 2], 3 * corner, lane, rate_);
    }
    limit_[lane] = motion.limit;
    error_[lane] = motion.error;
  }

  void set_time(std::size_t lane, double time) { time_[lane] = time; }

  /// Looks at all lanes.
  void look() {
    const MotionTag d;
    const Parallelogram<LaneNumber> rate = load(rate_);
    const auto now = moved(load(start_), rate, LaneNumber(hn::Load(d, time_)));
    const MotionLook<LaneNumber> look =
        look_in_lanes(now, rate, LaneNumber(hn::Load(d, limit_)), LaneNumber(hn::Load(d, error_)));
    hn::Store(look.distance.lanes, d, distance_);
    hn::Store(look.closing.lanes, d, closing_);
    hn::Store(look.free.lanes, d, free_);
  }

  MotionLook<double> look_of(std::size_t lane) const {
    return {distance_[lane], closing_[lane], free_[lane]};
  }

 private:
  using Values = double[12][most_motion_lanes];

  static void store(const NumberVector<double>& vector, std::size_t row, std::size_t lane,
                    Values& values) {
    values[row][lane] = vector.x;
    values[row + 1][lane] = vector.y;
    values[row + 2][lane] = vector.z;
  }

  Values start_ = {};
  Values rate_ = {};
  double limit_[most_motion_lanes] = {};
  double error_[most_motion_lanes] = {};
  double time_[most_motion_lanes] = {};
  double distance_[most_motion_lanes] = {};
  double closing_[most_motion_lanes] = {};
  double free_[most_motion_lanes] = {};
};

}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();
#endif
