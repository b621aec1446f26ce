// Compiled once per instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/geometry/segment_distances.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/geometry/segment_pairs_in_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

using Doubles = hn::CappedTag<double, 8>;
using Distance = LaneDistance<Doubles>;

/// Whether the range of double needs no scaling in any lane.
bool is_in_range(Distance::V extent) {
  const Doubles d;
  const auto inside = hn::And(hn::Gt(extent, hn::Set(d, least_distance_scale)),
                              hn::Lt(extent, hn::Set(d, largest_distance_scale)));
  return hn::AllTrue(d, hn::Or(inside, hn::Eq(extent, hn::Zero(d))));
}

void segment_distances_lanes(const Eigen::Vector3d* const* a, const Eigen::Vector3d* const* b,
                             std::size_t count, SegmentDistance* distances) {
  const Doubles d;
  for (std::size_t begin = 0; begin < count; begin += hn::Lanes(d)) {
    const std::size_t size = std::min(hn::Lanes(d), count - begin);
    const SegmentEnds<Doubles> ends_a(a + begin, size);
    const SegmentEnds<Doubles> ends_b(b + begin, size);
    const Distance::Vector p0 = ends_a.points(d, 0);
    const Distance::Vector p1 = ends_a.points(d, 1);
    const Distance::Vector q0 = ends_b.points(d, 0);
    const Distance::Vector q1 = ends_b.points(d, 1);
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
    const LaneResults<Doubles> results{Distance(differences)};
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
