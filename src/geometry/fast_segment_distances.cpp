// Compiled once per instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/geometry/fast_segment_distances.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/geometry/segment_pairs_in_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

using Doubles = hn::CappedTag<double, 8>;
using Floats = hn::CappedTag<float, 16>;
using HalfFloats = hn::Rebind<float, Doubles>;
using Wide = LaneDistance<Doubles>;
using Narrow = LaneDistance<Floats>;
using Ends = SegmentEnds<Floats>;

constexpr std::size_t most_lanes = hn::MaxLanes(Floats());

/// Below this extent [m] a pair is left to the robust kernel.
constexpr double least_extent = 0x1p-900;
/// Differences are scaled to have an extent from 2²⁰ on: their fourth powers do not overflow, and
/// those of which the squares underflow are nothing beside it (docs/numerics.md).
constexpr std::uint64_t scaled_exponent = 1023 + 20;

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

/// Differences of the lanes in float, scaled; made from doubles a part of the lanes at a time.
struct alignas(64) ScaledDifferences {
  float values[15][most_lanes];
  double extents[most_lanes];  // [m]
  double scales[most_lanes];   // back to metres

  ScaledDifferences(const Ends& a, const Ends& b) {
    for (std::size_t lane = 0; lane < hn::Lanes(Floats()); lane += hn::Lanes(Doubles())) {
      const Wide::Vector p0 = a.points(Doubles(), 0, lane);
      const Wide::Vector p1 = a.points(Doubles(), 1, lane);
      const Wide::Vector q0 = b.points(Doubles(), 0, lane);
      const Wide::Vector q1 = b.points(Doubles(), 1, lane);
      const Wide::V extent = Wide::extent(p0, p1, q0, q1);
      const Scale scale(extent);
      hn::Store(extent, Doubles(), extents + lane);
      hn::Store(scale.back, Doubles(), scales + lane);
      set(0, lane, Wide::subtract(p1, p0), scale.to);
      set(1, lane, Wide::subtract(q1, q0), scale.to);
      set(2, lane, Wide::subtract(p0, q0), scale.to);
      set(3, lane, Wide::subtract(p1, q0), scale.to);
      set(4, lane, Wide::subtract(p0, q1), scale.to);
    }
  }

  Narrow::Differences all() const { return {get(0), get(1), get(2), get(3), get(4)}; }

 private:
  void set(std::size_t which, std::size_t lane, const Wide::Vector& v, Wide::V scale) {
    const HalfFloats h;
    hn::Store(hn::DemoteTo(h, hn::Mul(v.x, scale)), h, values[3 * which] + lane);
    hn::Store(hn::DemoteTo(h, hn::Mul(v.y, scale)), h, values[3 * which + 1] + lane);
    hn::Store(hn::DemoteTo(h, hn::Mul(v.z, scale)), h, values[3 * which + 2] + lane);
  }
  Narrow::Vector get(std::size_t which) const {
    const Floats f;
    return {hn::Load(f, values[3 * which]), hn::Load(f, values[3 * which + 1]),
            hn::Load(f, values[3 * which + 2])};
  }
};

void fast_segment_distances_lanes(const Eigen::Vector3d* const* a, const Eigen::Vector3d* const* b,
                                  std::size_t count, SegmentDistance* distances) {
  const std::size_t lanes = hn::Lanes(Floats());
  for (std::size_t begin = 0; begin < count; begin += lanes) {
    const std::size_t size = std::min(lanes, count - begin);
    const ScaledDifferences differences({a + begin, size}, {b + begin, size});
    const LaneResults<Floats> results{Narrow(differences.all())};
    for (std::size_t lane = 0; lane < size; ++lane) {
      const std::size_t pair = begin + lane;
      const double extent = differences.extents[lane];
      const bool in_range = extent == 0.0 || extent > least_extent;
      if (!in_range) {
        distances[pair] = segment_distance(a[pair][0], a[pair][1], b[pair][0], b[pair][1]);
        continue;
      }
      distances[pair] = results.of(lane, fast_error * extent);
      distances[pair].delta *= differences.scales[lane];
      distances[pair].distance *= differences.scales[lane];
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
