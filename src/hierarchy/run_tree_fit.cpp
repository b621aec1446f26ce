// Compiled once per instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/hierarchy/run_tree_fit.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fiber_proximity/hierarchy/run_tree_kernels.hpp"
#include "src/hierarchy/enclosing_capsule-inl.hpp"
#include "src/hierarchy/segment_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

/// Beyond this magnitude squares leave the range of float: such a run is near everything [m].
constexpr double largest_magnitude = 1e18;

struct RunBox {
  float lower[3];
  float upper[3];
};

constexpr std::uint32_t points_per_run = run_width + 1;
constexpr std::uint32_t doubles_per_run = 3 * points_per_run + 1;  // one more fills a register

/// The origin's coordinates over and over, as they are to be subtracted from points in memory.
struct RepeatedOrigin {
  static constexpr std::uint32_t period = 12;  // of three coordinates in up to four lanes
  alignas(32) double values[period];

  explicit RepeatedOrigin(const Eigen::Vector3d& origin) {
    for (std::uint32_t i = 0; i < period; ++i) {
      values[i] = origin[i % 3];
    }
  }
};

/// Coordinates relative to the origin, in single precision, in the order of memory.
void make_relative(const double* coordinates, const RepeatedOrigin& origin, float* relative) {
  const hn::CappedTag<double, 4> d;
  const hn::Rebind<float, decltype(d)> floats;
  const auto limit = hn::Set(d, 2.0 * largest_magnitude);
  for (std::size_t i = 0; i < doubles_per_run; i += hn::Lanes(d)) {
    const auto difference = hn::Sub(hn::LoadU(d, coordinates + i),
                                    hn::LoadU(d, origin.values + i % RepeatedOrigin::period));
    hn::StoreU(hn::DemoteTo(floats, hn::Clamp(difference, hn::Neg(limit), limit)), floats,
               relative + i);
  }
}

/// The run's values of one axis: those of its points, then the last one's again and again.
void store_axis(Lanes values, std::size_t lane, float last, std::uint32_t count,
                float (&axis)[run_width + 1]) {
  const Floats d;
  const auto valid = hn::FirstN(d, count > lane ? count - lane : 0);
  hn::StoreU(hn::IfThenElse(valid, values, hn::Set(d, last)), d, axis + lane);
  axis[run_width] = last;
}

void load_points(const FiberAssembly& fibers, const RepeatedOrigin& origin, const RunSpan& span,
                 Run& run) {
  const std::vector<Eigen::Vector3d>& points = fibers.points();
  const double* coordinates = points[span.first_point].data();
  double copy[doubles_per_run] = {};
  if (points.size() - span.first_point <= points_per_run) {
    // Near the end of the points there is nothing to read beyond them.
    std::copy_n(coordinates, 3 * (span.segment_count + 1), copy);
    coordinates = copy;
  }
  float relative[doubles_per_run];
  make_relative(coordinates, origin, relative);
  const float* const last = relative + 3 * span.segment_count;
  const std::uint32_t count = span.segment_count + 1;
  const Floats d;
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(d)) {
    Lanes x;
    Lanes y;
    Lanes z;
    hn::LoadInterleaved3(d, relative + 3 * lane, x, y, z);
    store_axis(x, lane, last[0], count, run.x);
    store_axis(y, lane, last[1], count, run.y);
    store_axis(z, lane, last[2], count, run.z);
  }
}

/// Of the thickest of the run's segments [m].
double largest_radius(const FiberAssembly& fibers, const RunSpan& span) {
  if (fibers.radii().size() == 1) {
    return fibers.radii().front();
  }
  double radius = 0.0;
  for (std::uint32_t i = 0; i < span.segment_count; ++i) {
    radius = std::max(radius, fibers.segment_radius(span.first_point + i));
  }
  return radius;
}

/// Boxes of the run's segments along one axis, `reach` larger; the box of the run is theirs.
void fit_axis(const float (&points)[run_width + 1], float reach, float (&lower)[run_width],
              float (&upper)[run_width], float& run_lower, float& run_upper) {
  const Floats d;
  const auto reaches = hn::Set(d, reach);
  auto lowest = hn::Set(d, points[run_width] - reach);
  auto highest = hn::Set(d, points[run_width] + reach);
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(d)) {
    const auto start = hn::LoadU(d, points + lane);
    const auto end = hn::LoadU(d, points + lane + 1);
    const auto low = hn::Sub(hn::Min(start, end), reaches);
    const auto high = hn::Add(hn::Max(start, end), reaches);
    hn::Store(low, d, lower + lane);
    hn::Store(high, d, upper + lane);
    lowest = hn::Min(lowest, low);
    highest = hn::Max(highest, high);
  }
  run_lower = hn::GetLane(hn::MinOfLanes(d, lowest));
  run_upper = hn::GetLane(hn::MaxOfLanes(d, highest));
}

float largest_magnitude_of(const float (&values)[run_width + 1]) {
  const Floats d;
  auto largest = hn::Set(d, std::abs(values[run_width]));
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(d)) {
    largest = hn::Max(largest, hn::Abs(hn::LoadU(d, values + lane)));
  }
  return hn::GetLane(hn::MaxOfLanes(d, largest));
}

/// Largest distance of the run's points from its chord [m].
float sag(const Run& run) {
  const Floats d;
  const LaneSegments chord = broadcast_segment(run.x[0], run.y[0], run.z[0], run.x[run_width],
                                               run.y[run_width], run.z[run_width]);
  auto largest = hn::Zero(d);
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(d)) {
    const LaneVector point{hn::LoadU(d, run.x + lane), hn::LoadU(d, run.y + lane),
                           hn::LoadU(d, run.z + lane)};
    largest = hn::Max(largest, squared_distance_to(chord, subtract(point, chord.start)));
  }
  return std::sqrt(hn::GetLane(hn::MaxOfLanes(d, largest)));
}

/// A radius with the padding that makes all tests err on the safe side; infinite beyond the range
/// of float [m].
float padded_radius(const Run& run, double radius) {
  const double magnitude = std::max({radius, static_cast<double>(largest_magnitude_of(run.x)),
                                     static_cast<double>(largest_magnitude_of(run.y)),
                                     static_cast<double>(largest_magnitude_of(run.z))});
  return magnitude > largest_magnitude
             ? std::numeric_limits<float>::infinity()
             : static_cast<float>(radius) + static_cast<float>(magnitude) * relative_padding +
                   least_padding;
}

void fit_run(const FiberAssembly& fibers, const RepeatedOrigin& origin, const RunSpan& span,
             Run& run, BoxBlock& segments, RunBox& box) {
  load_points(fibers, origin, span, run);
  run.radius = padded_radius(run, largest_radius(fibers, span));
  if (std::isinf(run.radius)) {
    const float radius = run.radius;
    run = {};  // what is beyond the range is near everything, wherever it is
    run.radius = radius;
  }
  fit_axis(run.x, run.radius, segments.lower[0], segments.upper[0], box.lower[0], box.upper[0]);
  fit_axis(run.y, run.radius, segments.lower[1], segments.upper[1], box.lower[1], box.upper[1]);
  fit_axis(run.z, run.radius, segments.lower[2], segments.upper[2], box.lower[2], box.upper[2]);
}

void store(const Run& run, const RunBox& box, std::uint32_t lane, CapsuleBlock& capsules,
           BoxBlock& boxes) {
  const float start[3] = {run.x[0], run.y[0], run.z[0]};
  const float end[3] = {run.x[run_width], run.y[run_width], run.z[run_width]};
  for (int axis = 0; axis < 3; ++axis) {
    capsules.start[axis][lane] = start[axis];
    capsules.end[axis][lane] = end[axis];
    boxes.lower[axis][lane] = box.lower[axis];
    boxes.upper[axis][lane] = box.upper[axis];
  }
  capsules.radius[lane] = run.radius + sag(run);
}

/// Runs come in spatial order: where the next ones' points are, no processor can guess.
void prefetch(const FiberAssembly& fibers, const RunSpan& span) {
  constexpr std::uint32_t points_per_line = 2;
  for (std::uint32_t i = 0; i <= span.segment_count; i += points_per_line) {
    hwy::Prefetch(&fibers.points()[span.first_point + i]);
  }
}

void fit_groups_lanes(const FiberAssembly& fibers, const Eigen::Vector3d& origin,
                      const RunSpan* spans, std::uint32_t run_count, std::uint32_t begin,
                      std::uint32_t end, Run* runs, BoxBlock* segment_boxes, CapsuleBlock* capsules,
                      BoxBlock* boxes) {
  constexpr std::uint32_t ahead = 2 * run_width;
  const RepeatedOrigin repeated(origin);
  for (std::uint32_t group = begin; group < end; ++group) {
    for (std::uint32_t lane = 0; lane < run_width; ++lane) {
      RunBox box;
      // Lanes without a run repeat the last: nodes above need no special case.
      const std::uint32_t run = std::min(group * run_width + lane, run_count - 1);
      prefetch(fibers, spans[std::min(run + ahead, run_count - 1)]);
      fit_run(fibers, repeated, spans[run], runs[run], segment_boxes[run], box);
      store(runs[run], box, lane, capsules[group], boxes[group]);
    }
  }
}

float least_of(const float (&values)[run_width]) {
  return *std::min_element(values, values + run_width);
}

float largest_of(const float (&values)[run_width]) {
  return *std::max_element(values, values + run_width);
}

void fit_nodes_lanes(const BoxBlock* boxes_below, const CapsuleBlock* capsules_below,
                     std::uint32_t child_count, std::uint32_t begin, std::uint32_t end,
                     BoxBlock* boxes, CapsuleBlock* capsules) {
  for (std::uint32_t node = begin; node < end; ++node) {
    for (std::uint32_t lane = 0; lane < run_width; ++lane) {
      const std::uint32_t child = std::min(node * run_width + lane, child_count - 1);
      const SingleCapsule capsule = enclose(capsules_below[child]);
      for (int axis = 0; axis < 3; ++axis) {
        boxes[node].lower[axis][lane] = least_of(boxes_below[child].lower[axis]);
        boxes[node].upper[axis][lane] = largest_of(boxes_below[child].upper[axis]);
        capsules[node].start[axis][lane] = capsule.start[axis];
        capsules[node].end[axis][lane] = capsule.end[axis];
      }
      capsules[node].radius[lane] = capsule.radius;
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(fit_groups_lanes);
HWY_EXPORT(fit_nodes_lanes);

void fit_groups(const FiberAssembly& fibers, const Eigen::Vector3d& origin, const RunSpan* spans,
                std::uint32_t run_count, std::uint32_t begin, std::uint32_t end, Run* runs,
                BoxBlock* segment_boxes, CapsuleBlock* capsules, BoxBlock* boxes) {
  HWY_DYNAMIC_DISPATCH(fit_groups_lanes)
  (fibers, origin, spans, run_count, begin, end, runs, segment_boxes, capsules, boxes);
}

void fit_nodes(const BoxBlock* boxes_below, const CapsuleBlock* capsules_below,
               std::uint32_t child_count, std::uint32_t begin, std::uint32_t end, BoxBlock* boxes,
               CapsuleBlock* capsules) {
  HWY_DYNAMIC_DISPATCH(fit_nodes_lanes)
  (boxes_below, capsules_below, child_count, begin, end, boxes, capsules);
}

}  // namespace fiber
#endif
