// Compiled once per instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/hierarchy/run_tree_fit.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "src/hierarchy/run_tree_kernels.hpp"
#include "src/hierarchy/segment_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

/// Beyond this magnitude squares leave the range of float: such a segment is near everything [m].
constexpr float largest_magnitude = 1e18F;

constexpr std::uint32_t segments_per_group = run_width * run_width;

/// Two points of a segment as they are read: x₀ y₀ z₀ x₁, then z₀ x₁ y₁ z₁.
constexpr std::uint32_t half = 4;
struct alignas(32) GroupPoints {
  float first_halves[segments_per_group][half];
  float second_halves[segments_per_group][half];
};

/// The origin, as it is to be subtracted from either half.
struct HalvedOrigin {
  alignas(32) double first[half];
  alignas(32) double second[half];

  explicit HalvedOrigin(const Eigen::Vector3d& origin)
      : first{origin.x(), origin.y(), origin.z(), origin.x()},
        second{origin.z(), origin.x(), origin.y(), origin.z()} {}
};

/// Four coordinates relative to the origin, in single precision.
HWY_INLINE void make_relative(const double* coordinates, const double (&origin)[half],
                              float (&relative)[half]) {
  const hn::CappedTag<double, half> d;
  const hn::Rebind<float, decltype(d)> floats;
  const auto limit = hn::Set(d, 2.0 * static_cast<double>(largest_magnitude));
  for (std::size_t i = 0; i < half; i += hn::Lanes(d)) {
    const auto difference = hn::Sub(hn::LoadU(d, coordinates + i), hn::Load(d, origin + i));
    hn::StoreU(hn::DemoteTo(floats, hn::Clamp(difference, hn::Neg(limit), limit)), floats,
               relative + i);
  }
}

/// Radii with the padding that makes all tests err on the safe side [m].
/// @param largest magnitudes of coordinates
HWY_INLINE Lanes padded(Lanes radius, const LaneVector& largest) {
  const Floats d;
  const auto magnitude = hn::Max(hn::Max(radius, largest.x), hn::Max(largest.y, largest.z));
  const auto finite =
      hn::Add(hn::MulAdd(magnitude, hn::Set(d, relative_padding), radius), hn::Set(d, min_padding));
  return hn::IfThenElse(hn::Gt(magnitude, hn::Set(d, largest_magnitude)),
                        hn::Set(d, std::numeric_limits<float>::infinity()), finite);
}

HWY_INLINE LaneVector middle(const LaneVector& a, const LaneVector& b) {
  const auto half_of_one = hn::Set(Floats(), 0.5F);
  const LaneVector sum = add(a, b);
  return {hn::Mul(half_of_one, sum.x), hn::Mul(half_of_one, sum.y), hn::Mul(half_of_one, sum.z)};
}

/// A segment a lane.
struct LaneEnds {
  LaneVector start;
  LaneVector end;
  Lanes radius;

  HWY_INLINE LaneVector lower() const { return lower_corner(start, end, radius); }
  HWY_INLINE LaneVector upper() const { return upper_corner(start, end, radius); }

  void store(Run& run, std::size_t lane) const {
    HWY_NAMESPACE::store(start, run.start, lane);
    HWY_NAMESPACE::store(end, run.end, lane);
    hn::Store(radius, Floats(), run.radius + lane);
  }
};

/// Box of all lanes.
struct SingleBox {
  LaneVector lower;
  LaneVector upper;

  HWY_INLINE void take(const LaneVector& lower_corners, const LaneVector& upper_corners) {
    lower = minimum(lower, lower_corners);
    upper = maximum(upper, upper_corners);
  }

  void store(BoxBlock& block, std::uint32_t lane) const {
    const Floats d;
    block.lower[0][lane] = hn::GetLane(hn::MinOfLanes(d, lower.x));
    block.lower[1][lane] = hn::GetLane(hn::MinOfLanes(d, lower.y));
    block.lower[2][lane] = hn::GetLane(hn::MinOfLanes(d, lower.z));
    block.upper[0][lane] = hn::GetLane(hn::MaxOfLanes(d, upper.x));
    block.upper[1][lane] = hn::GetLane(hn::MaxOfLanes(d, upper.y));
    block.upper[2][lane] = hn::GetLane(hn::MaxOfLanes(d, upper.z));
  }
};

/// The box of no segments.
HWY_INLINE SingleBox empty_box() {
  const auto infinity = hn::Set(Floats(), std::numeric_limits<float>::infinity());
  const LaneVector infinities{infinity, infinity, infinity};
  return {infinities, negative(infinities)};
}

/// Segments come in spatial order: where the next ones' points are, no processor can guess.
void prefetch(const FiberAssembly& fibers, const std::uint32_t* first_points,
              std::uint32_t segment_count, std::uint32_t begin) {
  const std::uint32_t end = std::min(begin + run_width, segment_count);
  for (std::uint32_t segment = begin; segment < end; ++segment) {
    hwy::Prefetch(&fibers.points()[first_points[segment]]);
  }
}

/// Gives a lane without a child the box of another, so that nodes above need no special case.
void repeat(BoxBlock& boxes, std::uint32_t from, std::uint32_t lane) {
  for (int axis = 0; axis < 3; ++axis) {
    boxes.lower[axis][lane] = boxes.lower[axis][from];
    boxes.upper[axis][lane] = boxes.upper[axis][from];
  }
}

/// No larger than what is near everything: larger ones may not fit into a float [m].
float radius_of(double radius) {
  return static_cast<float>(std::min(radius, 2.0 * static_cast<double>(largest_magnitude)));
}

/// Reads the segments of a group, relative to an origin.
class GroupReader {
 public:
  GroupReader(const FiberAssembly& fibers, const Eigen::Vector3d& origin,
              const std::uint32_t* first_points, std::uint32_t segment_count)
      : origin_(origin),
        fibers_(fibers),
        first_points_(first_points),
        segment_count_(segment_count),
        same_radius_(fibers.radius_per() == RadiusPer::ASSEMBLY) {
    if (same_radius_) {
      std::fill_n(radii_, segments_per_group, radius_of(fibers.radii().front()));
    }
  }

  /// @param first segment of the group
  void read(std::uint32_t first) {
    constexpr std::uint32_t ahead = 2 * run_width;
    constexpr std::uint32_t second_half = 2;  // of the coordinates of two points
    for (std::uint32_t i = 0; i < segments_per_group; ++i) {
      if (i % run_width == 0) {
        prefetch(fibers_, first_points_, segment_count_, first + i + ahead);
      }
      // Lanes of the last run without a segment repeat the last segment.
      const std::uint32_t point = first_points_[std::min(first + i, segment_count_ - 1)];
      const double* const coordinates = fibers_.points()[point].data();
      make_relative(coordinates, origin_.first, points_.first_halves[i]);
      make_relative(coordinates + second_half, origin_.second, points_.second_halves[i]);
      if (!same_radius_) {
        radii_[i] = radius_of(fibers_.segment_radius(point));
      }
    }
  }

  /// Some segments of the group in lanes.
  HWY_INLINE LaneEnds ends(std::uint32_t first) const {
    const Floats d;
    LaneEnds ends;
    Lanes again;
    hn::LoadInterleaved4(d, points_.first_halves[first], ends.start.x, ends.start.y, ends.start.z,
                         again);
    hn::LoadInterleaved4(d, points_.second_halves[first], again, ends.end.x, ends.end.y,
                         ends.end.z);
    ends.radius = hn::LoadU(d, radii_ + first);
    return ends;
  }

 private:
  GroupPoints points_;
  const HalvedOrigin origin_;
  float radii_[segments_per_group];
  const FiberAssembly& fibers_;
  const std::uint32_t* const first_points_;
  const std::uint32_t segment_count_;
  const bool same_radius_;
};

/// Puts segments where they are into lanes, and the box of all into a lane of the block.
void fit_run(const GroupReader& group, std::uint32_t first, Run& run, BoxBlock& boxes,
             std::uint32_t lane) {
  SingleBox box = empty_box();
  for (std::uint32_t i = 0; i < run_width; i += static_cast<std::uint32_t>(hn::Lanes(Floats()))) {
    LaneEnds ends = group.ends(first + i);
    ends.radius = padded(ends.radius, maximum(absolute(ends.start), absolute(ends.end)));
    ends.store(run, i);
    box.take(ends.lower(), ends.upper());
  }
  box.store(boxes, lane);
}

/// Fits segments that move: halfway, thicker by as much as their ends leave the displacement
/// of their middle, which goes into the displacements.
///
/// Rounded, both states are off by u of the largest coordinate M, u = 2⁻²⁴; halfway is off by 2
/// u·M, half a displacement and what the ends have beside it by 3 u·M each. That makes 19 u·M in
/// space.
void fit_moving_run(const GroupReader& before, const GroupReader& after, std::uint32_t first,
                    Run& run, RunDisplacement& displacements, BoxBlock& boxes, std::uint32_t lane) {
  const Floats d;
  SingleBox box = empty_box();
  for (std::uint32_t i = 0; i < run_width; i += static_cast<std::uint32_t>(hn::Lanes(d))) {
    const LaneEnds from = before.ends(first + i);
    const LaneEnds to = after.ends(first + i);
    const LaneVector start_displacement = middle(to.start, negative(from.start));
    const LaneVector end_displacement = middle(to.end, negative(from.end));
    const LaneVector displacement = middle(start_displacement, end_displacement);
    const LaneVector beside = middle(end_displacement, negative(start_displacement));
    LaneEnds ends{middle(from.start, to.start), middle(from.end, to.end),
                  hn::Add(hn::Max(from.radius, to.radius), hn::Sqrt(dot(beside, beside)))};
    ends.radius = padded(ends.radius, maximum(maximum(absolute(from.start), absolute(from.end)),
                                              maximum(absolute(to.start), absolute(to.end))));
    ends.store(run, i);
    store(displacement, displacements.half, i);
    box.take(subtract(ends.lower(), absolute(displacement)),
             add(ends.upper(), absolute(displacement)));
  }
  box.store(boxes, lane);
}

/// Fits groups, with what it fits a run with.
/// @param fit called with the first segment of a run in its group, the run, and where its box goes
template <class Fit>
void fit_group(std::uint32_t group, std::uint32_t segment_count, BoxBlock& boxes, const Fit& fit) {
  const std::uint32_t first = group * segments_per_group;
  const std::uint32_t segments = std::min(segments_per_group, segment_count - first);
  const std::uint32_t run_count = (segments + run_width - 1) / run_width;
  for (std::uint32_t lane = 0; lane < run_count; ++lane) {
    fit(lane * run_width, group * run_width + lane, lane);
  }
  for (std::uint32_t lane = run_count; lane < run_width; ++lane) {
    repeat(boxes, run_count - 1, lane);
  }
}

void fit_groups_lanes(const TreeFibers& fibers, const std::uint32_t* first_points,
                      std::uint32_t segment_count, std::uint32_t begin, std::uint32_t end,
                      Run* runs, RunDisplacement* displacements, BoxBlock* boxes) {
  GroupReader before(fibers.before, fibers.origin_before, first_points, segment_count);
  if (!fibers.moves) {
    for (std::uint32_t group = begin; group < end; ++group) {
      before.read(group * segments_per_group);
      fit_group(group, segment_count, boxes[group],
                [&](std::uint32_t first, std::uint32_t run, std::uint32_t lane) {
                  fit_run(before, first, runs[run], boxes[group], lane);
                });
    }
    return;
  }
  GroupReader after(fibers.after, fibers.origin_after, first_points, segment_count);
  for (std::uint32_t group = begin; group < end; ++group) {
    before.read(group * segments_per_group);
    after.read(group * segments_per_group);
    fit_group(group, segment_count, boxes[group],
              [&](std::uint32_t first, std::uint32_t run, std::uint32_t lane) {
                fit_moving_run(before, after, first, runs[run], displacements[run], boxes[group],
                               lane);
              });
  }
}

void fit_nodes_lanes(const BoxBlock* boxes_below, std::uint32_t child_count, std::uint32_t begin,
                     std::uint32_t end, BoxBlock* boxes) {
  const Floats d;
  for (std::uint32_t node = begin; node < end; ++node) {
    for (std::uint32_t lane = 0; lane < run_width; ++lane) {
      const BoxBlock& below = boxes_below[std::min(node * run_width + lane, child_count - 1)];
      SingleBox box = empty_box();
      for (std::size_t i = 0; i < run_width; i += hn::Lanes(d)) {
        box.take(load(below.lower, i), load(below.upper, i));
      }
      box.store(boxes[node], lane);
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

void fit_groups(const TreeFibers& fibers, const std::uint32_t* first_points,
                std::uint32_t segment_count, std::uint32_t begin, std::uint32_t end, Run* runs,
                RunDisplacement* displacements, BoxBlock* boxes) {
  HWY_DYNAMIC_DISPATCH(fit_groups_lanes)
  (fibers, first_points, segment_count, begin, end, runs, displacements, boxes);
}

void fit_nodes(const BoxBlock* boxes_below, std::uint32_t child_count, std::uint32_t begin,
               std::uint32_t end, BoxBlock* boxes) {
  HWY_DYNAMIC_DISPATCH(fit_nodes_lanes)(boxes_below, child_count, begin, end, boxes);
}

}  // namespace fiber
#endif
