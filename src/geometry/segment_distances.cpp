// Compiled once per instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/geometry/segment_distances.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "src/geometry/segment_distance-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

using Doubles = hn::CappedTag<double, 8>;
using Distance = LaneDistance<Doubles>;

/// Ends of as many segments as there are lanes, coordinate by coordinate.
struct alignas(64) SegmentEnds {
  static constexpr std::size_t coordinates = 6;

  double values[coordinates][hn::MaxLanes(Doubles())];

  /// @param count from 1 to the number of lanes; those beyond it hold the last segment, too
  HWY_INLINE SegmentEnds(const Eigen::Vector3d* const* starts, std::size_t count) {
    for (std::size_t lane = 0; lane < hn::Lanes(Doubles()); ++lane) {
      const double* const from = starts[std::min(lane, count - 1)]->data();
      for (std::size_t i = 0; i < coordinates; ++i) {
        values[i][lane] = from[i];
      }
    }
  }

  /// The first ends (0) or the second ones (1).
  HWY_INLINE Distance::Vector points(std::size_t which) const {
    const Doubles d;
    return {hn::Load(d, values[3 * which]), hn::Load(d, values[3 * which + 1]),
            hn::Load(d, values[3 * which + 2])};
  }
};

/// Nearest points of the lanes, one kind of value after the other.
struct alignas(64) LaneResults {
  double values[6][hn::MaxLanes(Doubles())];

  HWY_INLINE explicit LaneResults(const Distance& nearest) {
    const Doubles d;
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

/// Whether the range of double needs no scaling in any lane.
bool is_in_range(Distance::V extent) {
  const Doubles d;
  const auto inside = hn::And(hn::Gt(extent, hn::Set(d, min_distance_scale)),
                              hn::Lt(extent, hn::Set(d, largest_distance_scale)));
  return hn::AllTrue(d, hn::Or(inside, hn::Eq(extent, hn::Zero(d))));
}

void segment_distances_lanes(const Eigen::Vector3d* const* a, const Eigen::Vector3d* const* b,
                             std::size_t count, SegmentDistance* distances) {
  const Doubles d;
  for (std::size_t begin = 0; begin < count; begin += hn::Lanes(d)) {
    const std::size_t size = std::min(hn::Lanes(d), count - begin);
    const SegmentEnds ends_a(a + begin, size);
    const SegmentEnds ends_b(b + begin, size);
    const Distance::Vector p0 = ends_a.points(0);
    const Distance::Vector p1 = ends_a.points(1);
    const Distance::Vector q0 = ends_b.points(0);
    const Distance::Vector q1 = ends_b.points(1);
    const Distance::V extent = Distance::extent(p0, p1, q0, q1);
    if (!is_in_range(extent)) {
      for (std::size_t pair = begin; pair < begin + size; ++pair) {
        distances[pair] = segment_distance(a[pair][0], a[pair][1], b[pair][0], b[pair][1]);
      }
      continue;
    }
    const Distance::Differences differences{Distance::subtract(p1, p0), Distance::subtract(q1, q0),
                                            Distance::subtract(p0, q0), Distance::subtract(p1, q0),
                                            Distance::subtract(p0, q1)};
    const LaneResults results{Distance(differences)};
    alignas(64) double errors[hn::MaxLanes(Doubles())];
    hn::Store(hn::Mul(extent, hn::Set(d, robust_error)), d, errors);
    for (std::size_t lane = 0; lane < size; ++lane) {
      distances[begin + lane] = results.of(lane, errors[lane]);
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(segment_distances_lanes);

void segment_distances(const Eigen::Vector3d* const* a, const Eigen::Vector3d* const* b,
                       std::size_t count, SegmentDistance* distances) {
  HWY_DYNAMIC_DISPATCH(segment_distances_lanes)(a, b, count, distances);
}

}  // namespace fiber
#endif
