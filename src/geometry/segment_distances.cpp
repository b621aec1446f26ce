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

constexpr std::size_t coordinates = 6;  // of the two ends of a segment

/// Ends of the segments of the lanes, coordinate by coordinate.
struct alignas(64) Ends {
  double values[coordinates][hn::MaxLanes(Doubles())];

  void set(std::size_t lane, const Eigen::Vector3d* start) {
    const double* const from = start->data();
    for (std::size_t i = 0; i < coordinates; ++i) {
      values[i][lane] = from[i];
    }
  }

  Distance::Vector point(std::size_t which) const {
    const Doubles d;
    return {hn::Load(d, values[3 * which]), hn::Load(d, values[3 * which + 1]),
            hn::Load(d, values[3 * which + 2])};
  }
};

/// Results of the lanes, one kind after the other.
struct alignas(64) Results {
  double values[7][hn::MaxLanes(Doubles())];

  Results(const Distance& nearest, Distance::V extent) {
    const Doubles d;
    hn::Store(nearest.s, d, values[0]);
    hn::Store(nearest.t, d, values[1]);
    hn::Store(hn::Neg(nearest.delta.x), d, values[2]);
    hn::Store(hn::Neg(nearest.delta.y), d, values[3]);
    hn::Store(hn::Neg(nearest.delta.z), d, values[4]);
    hn::Store(hn::Sqrt(nearest.squared), d, values[5]);
    hn::Store(hn::Mul(extent, hn::Set(d, robust_error)), d, values[6]);
  }

  SegmentDistance of(std::size_t lane) const {
    return {values[0][lane],
            values[1][lane],
            {values[2][lane], values[3][lane], values[4][lane]},
            values[5][lane],
            values[6][lane]};
  }
};

/// Whether the range of double needs no scaling in any lane.
bool is_in_range(Distance::V extent) {
  const Doubles d;
  const auto inside = hn::And(hn::Gt(extent, hn::Set(d, least_distance_scale)),
                              hn::Lt(extent, hn::Set(d, largest_distance_scale)));
  return hn::AllTrue(d, hn::Or(inside, hn::Eq(extent, hn::Zero(d))));
}

void segment_distances_lanes(const Eigen::Vector3d* const* a, const Eigen::Vector3d* const* b,
                             std::size_t count, SegmentDistance* distances) {
  const std::size_t lanes = hn::Lanes(Doubles());
  for (std::size_t begin = 0; begin < count; begin += lanes) {
    const std::size_t size = std::min(lanes, count - begin);
    Ends ends_a;
    Ends ends_b;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::size_t pair = begin + std::min(lane, size - 1);  // the last one again and again
      ends_a.set(lane, a[pair]);
      ends_b.set(lane, b[pair]);
    }
    const Distance::Vector p0 = ends_a.point(0);
    const Distance::Vector p1 = ends_a.point(1);
    const Distance::Vector q0 = ends_b.point(0);
    const Distance::Vector q1 = ends_b.point(1);
    const Distance::Differences differences{Distance::subtract(p1, p0), Distance::subtract(q1, q0),
                                            Distance::subtract(p0, q0), Distance::subtract(p1, q0),
                                            Distance::subtract(p0, q1)};
    const Distance::V extent = Distance::extent(p0, p1, q0, q1);
    if (is_in_range(extent)) {
      const Results results(Distance(differences), extent);
      for (std::size_t lane = 0; lane < size; ++lane) {
        distances[begin + lane] = results.of(lane);
      }
      continue;
    }
    for (std::size_t pair = begin; pair < begin + size; ++pair) {
      distances[pair] = segment_distance(a[pair][0], a[pair][1], b[pair][0], b[pair][1]);
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
