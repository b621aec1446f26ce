// Compiled once per instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/hierarchy/run_tree_fit.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "fiber_proximity/hierarchy/run_tree_kernels.hpp"
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
HWY_INLINE Lanes padded(Lanes radius, const LaneVector& start, const LaneVector& end) {
  const Floats d;
  const LaneVector largest = maximum(absolute(start), absolute(end));
  const auto magnitude = hn::Max(hn::Max(radius, largest.x), hn::Max(largest.y, largest.z));
  const auto finite = hn::Add(hn::MulAdd(magnitude, hn::Set(d, relative_padding), radius),
                              hn::Set(d, least_padding));
  return hn::IfThenElse(hn::Gt(magnitude, hn::Set(d, largest_magnitude)),
                        hn::Set(d, std::numeric_limits<float>::infinity()), finite);
}

/// Box of all lanes.
struct SingleBox {
  LaneVector lower;
  LaneVector upper;

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

/// Puts segments into lanes, and the box of all into a lane of the block.
void fit_run(const float (*first_halves)[half], const float (*second_halves)[half],
             const float* radii, Run& run, BoxBlock& boxes, std::uint32_t lane) {
  const Floats d;
  const auto infinity = hn::Set(d, std::numeric_limits<float>::infinity());
  const LaneVector infinities{infinity, infinity, infinity};
  SingleBox box{infinities, negative(infinities)};
  for (std::size_t i = 0; i < run_width; i += hn::Lanes(d)) {
    LaneVector start;
    LaneVector end;
    Lanes again;
    hn::LoadInterleaved4(d, first_halves[i], start.x, start.y, start.z, again);
    hn::LoadInterleaved4(d, second_halves[i], again, end.x, end.y, end.z);
    const auto radius = padded(hn::LoadU(d, radii + i), start, end);
    store(start, run.start, i);
    store(end, run.end, i);
    hn::Store(radius, d, run.radius + i);
    box.lower = minimum(box.lower, lower_corner(start, end, radius));
    box.upper = maximum(box.upper, upper_corner(start, end, radius));
  }
  box.store(boxes, lane);
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

class GroupFit {
 public:
  GroupFit(const FiberAssembly& fibers, const Eigen::Vector3d& origin,
           const std::uint32_t* first_points, std::uint32_t segment_count)
      : origin_(origin),
        fibers_(fibers),
        first_points_(first_points),
        segment_count_(segment_count),
        same_radius_(fibers.radii().size() == 1) {
    if (same_radius_) {
      std::fill_n(radii_, segments_per_group, radius_of(fibers.radii().front()));
    }
  }

  void fit(std::uint32_t group, Run* runs, BoxBlock& boxes) {
    const std::uint32_t first = group * segments_per_group;
    read(first);
    const std::uint32_t segments = std::min(segments_per_group, segment_count_ - first);
    const std::uint32_t run_count = (segments + run_width - 1) / run_width;
    for (std::uint32_t lane = 0; lane < run_count; ++lane) {
      const std::uint32_t begin = lane * run_width;
      fit_run(points_.first_halves + begin, points_.second_halves + begin, radii_ + begin,
              runs[group * run_width + lane], boxes, lane);
    }
    for (std::uint32_t lane = run_count; lane < run_width; ++lane) {
      repeat(boxes, run_count - 1, lane);
    }
  }

 private:
  void read(std::uint32_t first) {
    constexpr std::uint32_t ahead = 2 * run_width;
    constexpr std::uint32_t second_half = 2;  // of the coordinates of two points
    for (std::uint32_t i = 0; i < segments_per_group; ++i) {
      if (i % run_width == 0) {
        prefetch(fibers_, first_points_, segment_count_, first + i + ahead);
      }
      // Of the last group's last run, lanes without a segment repeat the last.
      const std::uint32_t point = first_points_[std::min(first + i, segment_count_ - 1)];
      const double* const coordinates = fibers_.points()[point].data();
      make_relative(coordinates, origin_.first, points_.first_halves[i]);
      make_relative(coordinates + second_half, origin_.second, points_.second_halves[i]);
      if (!same_radius_) {
        radii_[i] = radius_of(fibers_.segment_radius(point));
      }
    }
  }

  GroupPoints points_;
  const HalvedOrigin origin_;
  float radii_[segments_per_group];
  const FiberAssembly& fibers_;
  const std::uint32_t* const first_points_;
  const std::uint32_t segment_count_;
  const bool same_radius_;
};

void fit_groups_lanes(const FiberAssembly& fibers, const Eigen::Vector3d& origin,
                      const std::uint32_t* first_points, std::uint32_t segment_count,
                      std::uint32_t begin, std::uint32_t end, Run* runs, BoxBlock* boxes) {
  GroupFit fit(fibers, origin, first_points, segment_count);
  for (std::uint32_t group = begin; group < end; ++group) {
    fit.fit(group, runs, boxes[group]);
  }
}

void fit_nodes_lanes(const BoxBlock* boxes_below, std::uint32_t child_count, std::uint32_t begin,
                     std::uint32_t end, BoxBlock* boxes) {
  const Floats d;
  for (std::uint32_t node = begin; node < end; ++node) {
    for (std::uint32_t lane = 0; lane < run_width; ++lane) {
      const BoxBlock& below = boxes_below[std::min(node * run_width + lane, child_count - 1)];
      SingleBox box{load(below.lower, 0), load(below.upper, 0)};
      for (std::size_t i = hn::Lanes(d); i < run_width; i += hn::Lanes(d)) {
        box.lower = minimum(box.lower, load(below.lower, i));
        box.upper = maximum(box.upper, load(below.upper, i));
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

void fit_groups(const FiberAssembly& fibers, const Eigen::Vector3d& origin,
                const std::uint32_t* first_points, std::uint32_t segment_count, std::uint32_t begin,
                std::uint32_t end, Run* runs, BoxBlock* boxes) {
  HWY_DYNAMIC_DISPATCH(fit_groups_lanes)
  (fibers, origin, first_points, segment_count, begin, end, runs, boxes);
}

void fit_nodes(const BoxBlock* boxes_below, std::uint32_t child_count, std::uint32_t begin,
               std::uint32_t end, BoxBlock* boxes) {
  HWY_DYNAMIC_DISPATCH(fit_nodes_lanes)(boxes_below, child_count, begin, end, boxes);
}

}  // namespace fiber
#endif
