// Pairs of moving segments that are looked at together, one per lane: at the beginning of their
// motions, which rules most of them out, and on their way. Included once per instruction set, so it
// has the guard that Highway asks for instead of #pragma once.
#if defined(FIBER_MOTION_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FIBER_MOTION_LANES_INL
#undef FIBER_MOTION_LANES_INL
#else
#define FIBER_MOTION_LANES_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "src/geometry/segment_distance-inl.hpp"
#include "src/geometry/segment_motion-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {

using MotionTag = LaneNumber::Tag;

constexpr std::size_t max_motion_lanes = hn::MaxLanes(MotionTag());

/// Results in double err by less than this part of coordinates and limit
/// (docs/numerics.md).
constexpr double motion_roundings = 0x1p-46;

HWY_INLINE Parallelogram<LaneNumber> load(const double (&values)[12][max_motion_lanes]) {
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

/// Pairs that are followed one by one, a pair a lane: coordinate by coordinate, then lane.
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
  using Values = double[12][max_motion_lanes];

  static void store(const NumberVector<double>& vector, std::size_t row, std::size_t lane,
                    Values& values) {
    values[row][lane] = vector.x;
    values[row + 1][lane] = vector.y;
    values[row + 2][lane] = vector.z;
  }

  Values start_ = {};
  Values rate_ = {};
  double limit_[max_motion_lanes] = {};
  double error_[max_motion_lanes] = {};
  double time_[max_motion_lanes] = {};
  double distance_[max_motion_lanes] = {};
  double closing_[max_motion_lanes] = {};
  double free_[max_motion_lanes] = {};
};

/// The look at time 0, which shows for most pairs that they never come into contact, or that they
/// are in contact already.
class FirstLook {
 public:
  /// A bit for each pair.
  struct Seen {
    std::uint64_t touching = 0;  ///< in contact, proven
    std::uint64_t open = 0;      ///< to be looked at more closely
  };

  /// @param count from 1 to the number of lanes
  FirstLook(const SegmentMotions* motions, std::size_t count) {
    for (std::size_t lane = 0; lane < hn::Lanes(MotionTag()); ++lane) {
      const SegmentMotions& pair = motions[std::min(lane, count - 1)];
      read(pair.a_before, lane, a_before_);
      read(pair.a_after, lane, a_after_);
      read(pair.b_before, lane, b_before_);
      read(pair.b_after, lane, b_after_);
      limit_[lane] = pair.limit.sum();
      parts_[lane] = pair.limit.parts();
    }
  }

  Seen look() {
    const MotionTag d;
    LaneNumber limit(hn::Load(d, limit_));
    LaneNumber parts(hn::Load(d, parts_));
    Parallelogram<LaneNumber> start = differences(a_before_, b_before_);
    Parallelogram<LaneNumber> rate;
    NumberVector<LaneNumber> least = start.corners[0][0];
    NumberVector<LaneNumber> most = least;
    const Parallelogram<LaneNumber> end = differences(a_after_, b_after_);
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        rate.corners[i][j] = end.corners[i][j] - start.corners[i][j];
        least = smaller(smaller(least, start.corners[i][j]), end.corners[i][j]);
        most = larger(larger(most, start.corners[i][j]), end.corners[i][j]);
      }
    }
    LaneNumber largest = larger(larger(larger(-least.x, most.x), larger(-least.y, most.y)),
                                larger(-least.z, most.z));
    if (!hn::AllTrue(d, hn::And(LaneNumber(min_distance_scale) < largest,
                                largest < LaneNumber(largest_distance_scale)))) {
      const LaneNumber factor = factors_of(largest);
      start = scaled(factor, start);
      rate = scaled(factor, rate);
      limit = smaller(factor * limit, LaneNumber(longest_limit));
      parts = smaller(factor * parts, LaneNumber(longest_limit));
      largest = factor * largest;
      least = factor * least;
      most = factor * most;
    }
    const LaneNumber error = LaneNumber(motion_roundings) * (largest + parts);
    const LaneNumber reach = limit + error;
    const LaneNumber gap = larger(larger(larger(least.x, -most.x), larger(least.y, -most.y)),
                                  larger(least.z, -most.z));
    const auto is_apart = reach < gap;
    if (hn::AllTrue(d, is_apart)) {
      return {};
    }
    const MotionLook<LaneNumber> look = look_in_lanes(start, rate, limit, error);
    hn::Store(look.distance.lanes, d, distance_);
    hn::Store(look.closing.lanes, d, closing_);
    hn::Store(look.free.lanes, d, free_);
    // The distance of two points of the segments is hardly rounded, whichever they are.
    const auto is_touching = look.distance + error < limit - error;
    const auto never_touches = hn::Or(is_apart, LaneNumber(1.0) < look.free);
    return {bits_of(is_touching), bits_of(hn::Not(hn::Or(never_touches, is_touching)))};
  }

  /// A first look at a pair that must be followed.
  MotionLook<double> look_of(std::size_t lane) const {
    return {distance_[lane], closing_[lane], free_[lane]};
  }

 private:
  using Ends = double[6][max_motion_lanes];

  static void read(const Eigen::Vector3d* ends, std::size_t lane, Ends& values) {
    const double* const coordinates = ends->data();
    for (std::size_t i = 0; i < 6; ++i) {
      values[i][lane] = coordinates[i];
    }
  }

  static NumberVector<LaneNumber> end(const Ends& values, int which) {
    const MotionTag d;
    return {LaneNumber(hn::Load(d, values[3 * which])),
            LaneNumber(hn::Load(d, values[3 * which + 1])),
            LaneNumber(hn::Load(d, values[3 * which + 2]))};
  }

  static Parallelogram<LaneNumber> differences(const Ends& a, const Ends& b) {
    Parallelogram<LaneNumber> result;
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        result.corners[i][j] = end(a, i) - end(b, j);
      }
    }
    return result;
  }

  template <class Mask>
  static std::uint64_t bits_of(const Mask& mask) {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(MotionTag(), mask, bits);
    return bits[0];
  }

  static LaneNumber factors_of(LaneNumber largest) {
    const MotionTag d;
    alignas(64) double factors[max_motion_lanes];
    hn::Store(largest.lanes, d, factors);
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
      factors[lane] = scale_of(factors[lane]);
    }
    return LaneNumber(hn::Load(d, factors));
  }

  alignas(64) Ends a_before_;
  alignas(64) Ends a_after_;
  alignas(64) Ends b_before_;
  alignas(64) Ends b_after_;
  alignas(64) double limit_[max_motion_lanes];  // [m]
  alignas(64) double parts_[max_motion_lanes];  // [m] which the limit is rounded by a part of
  alignas(64) double distance_[max_motion_lanes];
  alignas(64) double closing_[max_motion_lanes];
  alignas(64) double free_[max_motion_lanes];
};

}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();
#endif
