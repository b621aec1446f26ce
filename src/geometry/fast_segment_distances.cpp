// Compiled once per instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/geometry/fast_segment_distances.cpp"
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
using Floats = hn::Rebind<float, Doubles>;
using Wide = LaneDistance<Doubles>;
using Narrow = LaneDistance<Floats>;

constexpr std::size_t coordinates = 6;  // of the two ends of a segment
constexpr std::size_t most_lanes = hn::MaxLanes(Doubles());

/// Below this extent [m] a pair is left to the robust kernel.
constexpr double least_extent = 0x1p-900;
/// Differences are scaled to have an extent from 2²⁰ on: their fourth powers, and the squares of
/// what is 2⁻⁴⁵ of that, still are normal floats.
constexpr std::uint64_t scaled_exponent = 1023 + 20;

/// Ends of the segments of the lanes, coordinate by coordinate.
struct alignas(64) Ends {
  double values[coordinates][most_lanes];

  void set(std::size_t lane, const Eigen::Vector3d* start) {
    const double* const from = start->data();
    for (std::size_t i = 0; i < coordinates; ++i) {
      values[i][lane] = from[i];
    }
  }

  Wide::Vector point(std::size_t which) const {
    const Doubles d;
    return {hn::Load(d, values[3 * which]), hn::Load(d, values[3 * which + 1]),
            hn::Load(d, values[3 * which + 2])};
  }
};

/// The power of two that brings the extent to [2²⁰, 2²¹), and its inverse.
struct Scale {
  Wide::V to;
  Wide::V back;

  explicit Scale(Wide::V extent) {
    const Doubles d;
    const hn::Rebind<std::uint64_t, Doubles> bits;
    const auto safe = hn::Max(extent, hn::Set(d, least_extent));
    const auto exponent =
        hn::And(hn::BitCast(bits, safe), hn::Set(bits, std::uint64_t{0x7FF} << 52U));
    const auto bias = hn::Set(bits, std::uint64_t{1023} << 52U);
    const auto wanted = hn::Set(bits, scaled_exponent << 52U);
    to = hn::BitCast(d, hn::Sub(hn::Add(wanted, bias), exponent));
    back = hn::BitCast(d, hn::Sub(hn::Add(exponent, bias), wanted));
  }
};

Narrow::V demoted(Wide::V value, Wide::V scale) {
  return hn::DemoteTo(Floats(), hn::Mul(value, scale));
}

Narrow::Vector demoted(const Wide::Vector& v, Wide::V scale) {
  return {demoted(v.x, scale), demoted(v.y, scale), demoted(v.z, scale)};
}

/// Results of the lanes, one kind after the other.
struct alignas(64) Results {
  double values[7][most_lanes];

  Results(const Narrow& nearest, Wide::V extent, Wide::V scale) {
    const Doubles d;
    const auto promoted = [&](Narrow::V value) { return hn::PromoteTo(d, value); };
    hn::Store(promoted(nearest.s), d, values[0]);
    hn::Store(promoted(nearest.t), d, values[1]);
    hn::Store(hn::Mul(promoted(hn::Neg(nearest.delta.x)), scale), d, values[2]);
    hn::Store(hn::Mul(promoted(hn::Neg(nearest.delta.y)), scale), d, values[3]);
    hn::Store(hn::Mul(promoted(hn::Neg(nearest.delta.z)), scale), d, values[4]);
    hn::Store(hn::Mul(promoted(hn::Sqrt(nearest.squared)), scale), d, values[5]);
    hn::Store(extent, d, values[6]);
  }

  SegmentDistance of(std::size_t lane) const {
    return {values[0][lane],
            values[1][lane],
            {values[2][lane], values[3][lane], values[4][lane]},
            values[5][lane],
            fast_error * extent(lane)};
  }

  double extent(std::size_t lane) const { return values[6][lane]; }
};

Results distances_of(const Ends& ends_a, const Ends& ends_b) {
  const Wide::Vector p0 = ends_a.point(0);
  const Wide::Vector p1 = ends_a.point(1);
  const Wide::Vector q0 = ends_b.point(0);
  const Wide::Vector q1 = ends_b.point(1);
  const Wide::V extent = Wide::extent(p0, p1, q0, q1);
  const Scale scale(extent);
  const auto difference = [&](const Wide::Vector& a, const Wide::Vector& b) {
    return demoted(Wide::subtract(a, b), scale.to);
  };
  const Narrow nearest({difference(p1, p0), difference(q1, q0), difference(p0, q0),
                        difference(p1, q0), difference(p0, q1)});
  return {nearest, extent, scale.back};
}

void fast_segment_distances_lanes(const Eigen::Vector3d* const* a, const Eigen::Vector3d* const* b,
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
    const Results results = distances_of(ends_a, ends_b);
    for (std::size_t lane = 0; lane < size; ++lane) {
      const std::size_t pair = begin + lane;
      const double extent = results.extent(lane);
      const bool in_range = extent == 0.0 || extent > least_extent;
      distances[pair] = in_range ? results.of(lane)
                                 : segment_distance(a[pair][0], a[pair][1], b[pair][0], b[pair][1]);
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(fast_segment_distances_lanes);

void fast_segment_distances(const Eigen::Vector3d* const* a, const Eigen::Vector3d* const* b,
                            std::size_t count, SegmentDistance* distances) {
  HWY_DYNAMIC_DISPATCH(fast_segment_distances_lanes)(a, b, count, distances);
}

}  // namespace fiber
#endif
