// A capsule around up to eight others.
// Included once per instruction set, so it has the guard that Highway asks for.
#if defined(FIBER_ENCLOSING_CAPSULE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FIBER_ENCLOSING_CAPSULE_INL
#undef FIBER_ENCLOSING_CAPSULE_INL
#else
#define FIBER_ENCLOSING_CAPSULE_INL
#endif

#include <hwy/highway.h>

#include <cmath>

#include "src/hierarchy/segment_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {

/// Sums over all children: of their axes, turned the same way as the first, and of their ends.
struct AxisSums {
  float direction[3] = {};
  float ends[3] = {};
};

HWY_INLINE AxisSums sum_axes(const CapsuleBlock& block) {
  const Floats d;
  float first[3];
  for (int axis = 0; axis < 3; ++axis) {
    first[axis] = block.end[axis][0] - block.start[axis][0];
  }
  AxisSums sums;
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(d)) {
    const LaneVector start = load(block.start, lane);
    const LaneVector end = load(block.end, lane);
    const LaneVector direction = subtract(end, start);
    const auto sign = hn::CopySign(hn::Set(d, 1.0F), dot(direction, spread(first)));
    sums.direction[0] += hn::GetLane(hn::SumOfLanes(d, hn::Mul(direction.x, sign)));
    sums.direction[1] += hn::GetLane(hn::SumOfLanes(d, hn::Mul(direction.y, sign)));
    sums.direction[2] += hn::GetLane(hn::SumOfLanes(d, hn::Mul(direction.z, sign)));
    const LaneVector both = add(start, end);
    sums.ends[0] += hn::GetLane(hn::SumOfLanes(d, both.x));
    sums.ends[1] += hn::GetLane(hn::SumOfLanes(d, both.y));
    sums.ends[2] += hn::GetLane(hn::SumOfLanes(d, both.z));
  }
  return sums;
}

struct SingleCapsule {
  float start[3];
  float end[3];
  float radius;
};

/// Largest distance of the block's capsules from a segment, their radii included [m].
HWY_INLINE float reach_of(const CapsuleBlock& block, const LaneSegments& segment) {
  const Floats d;
  auto radius = hn::Zero(d);
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(d)) {
    // The distance from a convex set is largest at an end.
    const auto start =
        squared_distance_to(segment, subtract(load(block.start, lane), segment.start));
    const auto end = squared_distance_to(segment, subtract(load(block.end, lane), segment.start));
    radius = hn::Max(radius, hn::Add(hn::Sqrt(hn::Max(start, end)), load(block.radius, lane)));
  }
  return hn::GetLane(hn::MaxOfLanes(d, radius));
}

/// A capsule around the block's, its axis their mean one, as long as they reach along it.
HWY_INLINE SingleCapsule enclose(const CapsuleBlock& block) {
  const Floats d;
  AxisSums sums = sum_axes(block);
  const float length = std::hypot(sums.direction[0], sums.direction[1], sums.direction[2]);
  float magnitude = 0.0F;
  for (int axis = 0; axis < 3; ++axis) {
    // Axes that cancel leave a sphere.
    sums.direction[axis] = length > least_padding ? sums.direction[axis] / length : 0.0F;
    sums.ends[axis] *= 0.5F / run_width;
    magnitude += std::abs(sums.ends[axis]);
  }
  const LaneVector direction = spread(sums.direction);
  const LaneVector middle = spread(sums.ends);
  auto low = hn::Zero(d);
  auto high = hn::Zero(d);
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(d)) {
    const auto start = dot(subtract(load(block.start, lane), middle), direction);
    const auto end = dot(subtract(load(block.end, lane), middle), direction);
    low = hn::Min(low, hn::Min(start, end));
    high = hn::Max(high, hn::Max(start, end));
  }
  const float lowest = hn::GetLane(hn::MinOfLanes(d, low));
  const float highest = hn::GetLane(hn::MaxOfLanes(d, high));
  SingleCapsule capsule;
  for (int axis = 0; axis < 3; ++axis) {
    capsule.start[axis] = sums.ends[axis] + lowest * sums.direction[axis];
    capsule.end[axis] = sums.ends[axis] + highest * sums.direction[axis];
  }
  capsule.radius = reach_of(block, lane_segments(spread(capsule.start), spread(capsule.end))) +
                   (magnitude + highest - lowest) * relative_padding;
  return capsule;
}

}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();
#endif
