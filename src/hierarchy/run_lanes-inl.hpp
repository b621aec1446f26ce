// A segment, or its box, against the eight of a run.
// Included once per instruction set, so it has the guard that Highway asks for.
#if defined(FIBER_RUN_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FIBER_RUN_LANES_INL
#undef FIBER_RUN_LANES_INL
#else
#define FIBER_RUN_LANES_INL
#endif

#include <hwy/highway.h>

#include "fiber_proximity/geometry/point_pair.hpp"
#include "src/hierarchy/moving_lanes-inl.hpp"
#include "src/hierarchy/segment_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {

/// Bits of the block's lanes whose boxes overlap the box in one lane of another. Infinite boxes
/// overlap everything.
HWY_INLINE std::uint32_t overlapping(const BoxBlock& block, const BoxBlock& other,
                                     std::uint32_t other_lane) {
  const LaneVector lower = spread(other.lower, other_lane);
  const LaneVector upper = spread(other.upper, other_lane);
  std::uint32_t bits = 0;
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(Floats())) {
    bits |= bits_of(boxes_overlap(load(block.lower, lane), load(block.upper, lane), lower, upper))
            << lane;
  }
  return bits;
}

/// Boxes of a run's segments, where they are and where they move.
template <bool moves>
HWY_INLINE void fit_boxes(const RunTreeView& tree, std::uint32_t which, BoxBlock& boxes) {
  const Run& run = tree.runs[which];
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(Floats())) {
    const LaneVector start = load(run.start, lane);
    const LaneVector end = load(run.end, lane);
    const auto radius = load(run.radius, lane);
    LaneVector lower = lower_corner(start, end, radius);
    LaneVector upper = upper_corner(start, end, radius);
    if constexpr (moves) {
      const LaneVector way = absolute(load(tree.ways[which].half, lane));
      lower = subtract(lower, way);
      upper = add(upper, way);
    }
    store(lower, boxes.lower, lane);
    store(upper, boxes.upper, lane);
  }
}

/// Bits of a run's segments whose lines may come within the bound of that of a segment of another,
/// in the other tree.
template <bool moves>
HWY_INLINE std::uint32_t near_lines(const RunTreeView& tree, std::uint32_t which,
                                    const RunTreeView& other_tree, std::uint32_t other_which,
                                    std::uint32_t other_lane, float bound) {
  const Floats d;
  const Run& run = tree.runs[which];
  const Run& other = other_tree.runs[other_which];
  const LaneVector start = spread(other.start, other_lane);
  const LaneVector u = subtract(spread(other.end, other_lane), start);
  const auto reach = hn::Set(d, other.radius[other_lane] + bound);
  std::uint32_t bits = 0;
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(d)) {
    const LaneVector starts = load(run.start, lane);
    const LaneVector v = subtract(load(run.end, lane), starts);
    const LaneVector w = subtract(start, starts);
    const auto reaches = hn::Add(reach, load(run.radius, lane));
    if constexpr (moves) {
      const LaneVector way = subtract(spread(other_tree.ways[other_which].half, other_lane),
                                      load(tree.ways[which].half, lane));
      bits |= bits_of(moving_lines_near(u, v, w, way, reaches)) << lane;
    } else {
      bits |= bits_of(lines_near(u, v, w, reaches)) << lane;
    }
  }
  return bits;
}

/// Bits of the run's segments, by their first points, that share a point with another segment.
/// Points p and p + 1 start segments of one fibre: the last point of a fibre starts none.
HWY_INLINE std::uint32_t sharing_point(const std::uint32_t* first_points, std::uint32_t other) {
  const hn::RebindToUnsigned<Floats> d;
  std::uint32_t bits = 0;
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(d)) {
    const auto points = hn::LoadU(d, first_points + lane);
    const auto shared =
        hn::Or(hn::Eq(points, hn::Set(d, other - 1)), hn::Eq(points, hn::Set(d, other + 1)));
    bits |= bits_of(hn::RebindMask(Floats(), shared)) << lane;
  }
  return bits;
}

/// Bits of the run's segments, by their first points, that are in the range.
HWY_INLINE std::uint32_t in_range(const std::uint32_t* first_points, PointRange range) {
  const hn::RebindToUnsigned<Floats> d;
  const auto begin = hn::Set(d, range.begin);
  const auto size = hn::Set(d, range.end - range.begin);
  std::uint32_t bits = 0;
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(d)) {
    const auto places = hn::Sub(hn::LoadU(d, first_points + lane), begin);
    bits |= bits_of(hn::RebindMask(Floats(), hn::Lt(places, size))) << lane;
  }
  return bits;
}

/// Boxes larger by the bound on all sides.
HWY_INLINE void inflate(const BoxBlock& boxes, float bound, BoxBlock& larger) {
  const auto bounds = hn::Set(Floats(), bound);
  const LaneVector reach{bounds, bounds, bounds};
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(Floats())) {
    store(subtract(load(boxes.lower, lane), reach), larger.lower, lane);
    store(add(load(boxes.upper, lane), reach), larger.upper, lane);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();
#endif
