// Compiled once per instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/hierarchy/run_tree_kernels.cpp"
#include "fiber_proximity/hierarchy/run_tree_kernels.hpp"

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/hierarchy/segment_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// ---- fitting
// -------------------------------------------------------------------------------------

/// Beyond this magnitude squares leave the range of float: such a run is near everything [m].
constexpr double largest_magnitude = 1e18;

/// Rounding a point, and all that the tests of segment_lanes-inl.hpp do with it, errs by less than
/// 32 u of the largest coordinate, u = 2⁻²⁴; the constant keeps it alive where floats run out [m].
constexpr float relative_padding = 0x1p-19F;
constexpr float least_padding = 0x1p-60F;

struct RunBox {
  float lower[3];
  float upper[3];
};

float as_float(double relative) {
  return static_cast<float>(
      std::clamp(relative, -2.0 * largest_magnitude, 2.0 * largest_magnitude));
}

/// Copies the points of the run; returns the largest of its segments' radii [m].
double load_points(const FiberAssembly& fibers, const Eigen::Vector3d& origin, const RunSpan& span,
                   Run& run) {
  const Eigen::Vector3d* points = fibers.points().data() + span.first_point;
  double radius = 0.0;
  for (std::uint32_t i = 0; i <= run_width; ++i) {
    const Eigen::Vector3d& point = points[std::min(i, span.segment_count)];
    run.x[i] = as_float(point.x() - origin.x());
    run.y[i] = as_float(point.y() - origin.y());
    run.z[i] = as_float(point.z() - origin.z());
  }
  for (std::uint32_t i = 0; i < span.segment_count; ++i) {
    radius = std::max(radius, fibers.segment_radius(span.first_point + i));
  }
  return radius;
}

void box_of(const float (&values)[run_width + 1], float& lower, float& upper) {
  const Floats d;
  auto low = hn::Set(d, values[run_width]);
  auto high = low;
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(d)) {
    const auto part = hn::LoadU(d, values + lane);
    low = hn::Min(low, part);
    high = hn::Max(high, part);
  }
  lower = hn::GetLane(hn::MinOfLanes(d, low));
  upper = hn::GetLane(hn::MaxOfLanes(d, high));
}

/// Largest squared distance of the run's points from its chord [m²].
float squared_sag(const Run& run) {
  const Floats d;
  const LaneSegments chord = broadcast_segment(run.x[0], run.y[0], run.z[0], run.x[run_width],
                                               run.y[run_width], run.z[run_width]);
  auto largest = hn::Zero(d);
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(d)) {
    const LaneVector point{hn::LoadU(d, run.x + lane), hn::LoadU(d, run.y + lane),
                           hn::LoadU(d, run.z + lane)};
    largest = hn::Max(largest, squared_distance_to(chord, subtract(point, chord.start)));
  }
  return hn::GetLane(hn::MaxOfLanes(d, largest));
}

/// A run that tests as near to everything.
void fit_everything(Run& run, RunBox& box) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  run = {};
  run.radius = infinity;
  std::fill_n(box.lower, 3, -infinity);
  std::fill_n(box.upper, 3, infinity);
}

void fit_run(const FiberAssembly& fibers, const Eigen::Vector3d& origin, const RunSpan& span,
             Run& run, RunBox& box) {
  const double radius = load_points(fibers, origin, span, run);
  box_of(run.x, box.lower[0], box.upper[0]);
  box_of(run.y, box.lower[1], box.upper[1]);
  box_of(run.z, box.lower[2], box.upper[2]);
  double magnitude = radius;
  for (int axis = 0; axis < 3; ++axis) {
    magnitude = std::max(
        {magnitude, -static_cast<double>(box.lower[axis]), static_cast<double>(box.upper[axis])});
  }
  if (magnitude > largest_magnitude) {
    fit_everything(run, box);
    return;
  }
  run.radius =
      static_cast<float>(radius) + static_cast<float>(magnitude) * relative_padding + least_padding;
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] -= run.radius;
    box.upper[axis] += run.radius;
  }
}

void store(const Run& run, const RunBox& box, std::uint32_t lane, ChordBlock& chords,
           BoxBlock& boxes) {
  const float start[3] = {run.x[0], run.y[0], run.z[0]};
  const float end[3] = {run.x[run_width], run.y[run_width], run.z[run_width]};
  for (int axis = 0; axis < 3; ++axis) {
    chords.start[axis][lane] = start[axis];
    chords.end[axis][lane] = end[axis];
    boxes.lower[axis][lane] = box.lower[axis];
    boxes.upper[axis][lane] = box.upper[axis];
  }
  chords.radius[lane] = run.radius + std::sqrt(squared_sag(run));
}

void FitGroups(const FiberAssembly& fibers, const Eigen::Vector3d& origin, const RunSpan* spans,
               std::uint32_t run_count, std::uint32_t begin, std::uint32_t end, Run* runs,
               ChordBlock* chords, BoxBlock* boxes) {
  for (std::uint32_t group = begin; group < end; ++group) {
    const std::uint32_t first = group * run_width;
    const std::uint32_t count = std::min(run_width, run_count - first);
    for (std::uint32_t lane = 0; lane < run_width; ++lane) {
      RunBox box;
      // Lanes without a run repeat the last: boxes of groups need no special case.
      const std::uint32_t run = first + std::min(lane, count - 1);
      fit_run(fibers, origin, spans[run], runs[run], box);
      store(runs[run], box, lane, chords[group], boxes[group]);
    }
  }
}

// ---- traversal
// -----------------------------------------------------------------------------------

/// A box, spread over all lanes and grown by the bound.
struct LaneBox {
  LaneVector lower;
  LaneVector upper;
};

LaneBox broadcast_box(const float (&lower)[3], const float (&upper)[3], float bound) {
  const Floats d;
  return {
      {hn::Set(d, lower[0] - bound), hn::Set(d, lower[1] - bound), hn::Set(d, lower[2] - bound)},
      {hn::Set(d, upper[0] + bound), hn::Set(d, upper[1] + bound), hn::Set(d, upper[2] + bound)}};
}

LaneBox broadcast_lane(const BoxBlock& block, std::uint32_t lane, float bound) {
  const float lower[3] = {block.lower[0][lane], block.lower[1][lane], block.lower[2][lane]};
  const float upper[3] = {block.upper[0][lane], block.upper[1][lane], block.upper[2][lane]};
  return broadcast_box(lower, upper, bound);
}

/// Bits of the lanes of the block that overlap the box. Written so that infinite boxes do.
std::uint32_t overlapping(const BoxBlock& block, const LaneBox& box) {
  const Floats d;
  std::uint32_t bits = 0;
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(d)) {
    const auto apart =
        hn::Or(hn::Or(hn::Or(hn::Gt(hn::Load(d, block.lower[0] + lane), box.upper.x),
                             hn::Gt(box.lower.x, hn::Load(d, block.upper[0] + lane))),
                      hn::Or(hn::Gt(hn::Load(d, block.lower[1] + lane), box.upper.y),
                             hn::Gt(box.lower.y, hn::Load(d, block.upper[1] + lane)))),
               hn::Or(hn::Gt(hn::Load(d, block.lower[2] + lane), box.upper.z),
                      hn::Gt(box.lower.z, hn::Load(d, block.upper[2] + lane))));
    bits |= bits_of(hn::Not(apart)) << lane;
  }
  return bits;
}

constexpr std::uint32_t first_bits(std::uint32_t count) { return (1U << count) - 1U; }

std::uint32_t take_lowest(std::uint32_t& bits) {
  const auto lane = static_cast<std::uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
  bits &= bits - 1;
  return lane;
}

/// Children of a node that there are.
std::uint32_t child_bits(const RunTreeLevel& level, std::uint32_t node) {
  return first_bits(std::min(run_width, level.child_count - node * run_width));
}

/// All pairs of the groups of one tree and the runs of another, or of the same.
class Finder {
 public:
  Finder(const RunTreeView& a, const RunTreeView& b, PairSink& sink, QueryCounts& counts)
      : a_(a), b_(b), self_(a.runs == b.runs), sink_(sink), counts_(counts), bound_(sink.bound()) {}

  /// Whether to go on.
  bool find(std::uint32_t group) {
    const BoxBlock& block = a_.levels[0].nodes[group];
    float lower[3];
    float upper[3];
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = *std::min_element(block.lower[axis], block.lower[axis] + run_width);
      upper[axis] = *std::max_element(block.upper[axis], block.upper[axis] + run_width);
    }
    // Near runs first: those of the group itself.
    if (self_ && !visit_group(group, group, child_bits(a_.levels[0], group))) {
      return false;
    }
    return descend(group, lower, upper);
  }

 private:
  struct Node {
    std::uint32_t level;
    std::uint32_t index;
  };

  bool descend(std::uint32_t group, const float (&lower)[3], const float (&upper)[3]) {
    Node stack[RunTreeView::most_levels * run_width];
    std::uint32_t size = 0;
    stack[size++] = {b_.level_count - 1, 0};
    while (size > 0) {
      const Node node = stack[--size];
      const RunTreeLevel& level = b_.levels[node.level];
      std::uint32_t bits =
          child_bits(level, node.index) &
          overlapping(level.nodes[node.index], broadcast_box(lower, upper, bound_));
      count(run_width, bits);
      if (node.level == 0) {
        if (bits != 0 && !(self_ && node.index == group) && !visit_group(group, node.index, bits)) {
          return false;
        }
        continue;
      }
      while (bits != 0) {
        const std::uint32_t child = node.index * run_width + take_lowest(bits);
        // Of a tree with itself, each pair of groups once: later ones only.
        const std::uint32_t last_group = ((child + 1) << (3U * (node.level - 1))) - 1U;
        if (!self_ || last_group > group) {
          stack[size++] = {node.level - 1, child};
        }
      }
    }
    return true;
  }

  /// Pairs of runs of group g of a and of the chosen lanes of group h of b.
  bool visit_group(std::uint32_t g, std::uint32_t h, std::uint32_t chosen) {
    const bool same = self_ && g == h;
    std::uint32_t rows = child_bits(a_.levels[0], g);
    while (rows != 0) {
      const std::uint32_t row = take_lowest(rows);
      const std::uint32_t a = g * run_width + row;
      // Of a group with itself: a run with itself, and with those after it.
      const std::uint32_t wanted = same ? chosen & ~first_bits(row) : chosen;
      std::uint32_t bits = wanted & overlapping(b_.levels[0].nodes[h],
                                                broadcast_lane(a_.levels[0].nodes[g], row, bound_));
      count(run_width, bits);
      if (bits != 0) {
        bits &= near_chords(g, row, h);
      }
      while (bits != 0) {
        const std::uint32_t b = h * run_width + take_lowest(bits);
        if (!visit_runs(a, b)) {
          return false;
        }
      }
    }
    return true;
  }

  /// Bits of the lanes of group h whose capsules around runs come near that of run `row` of g.
  std::uint32_t near_chords(std::uint32_t g, std::uint32_t row, std::uint32_t h) const {
    const Floats d;
    const ChordBlock& a = a_.chords[g];
    const ChordBlock& b = b_.chords[h];
    const LaneSegments chord = broadcast_segment(a.start[0][row], a.start[1][row], a.start[2][row],
                                                 a.end[0][row], a.end[1][row], a.end[2][row]);
    const auto reach = hn::Set(d, a.radius[row] + bound_);
    std::uint32_t bits = 0;
    for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(d)) {
      const LaneSegments chords =
          lane_segments({hn::Load(d, b.start[0] + lane), hn::Load(d, b.start[1] + lane),
                         hn::Load(d, b.start[2] + lane)},
                        {hn::Load(d, b.end[0] + lane), hn::Load(d, b.end[1] + lane),
                         hn::Load(d, b.end[2] + lane)});
      bits |= bits_of(near(chord, chords, hn::Add(reach, hn::Load(d, b.radius + lane)))) << lane;
    }
    return bits;
  }

  bool visit_runs(std::uint32_t a, std::uint32_t b) {
    const RunSpan& span_a = a_.spans[a];
    const RunSpan& span_b = b_.spans[b];
    const bool same = self_ && a == b;
    std::uint8_t near_bits[run_width] = {};
    std::uint32_t any = 0;
    const float reach = a_.runs[a].radius + b_.runs[b].radius + bound_;
    for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(Floats())) {
      any |= near_segments(a_.runs[a], span_a.segment_count, b_.runs[b], lane, reach, near_bits);
    }
    if (any == 0) {
      return true;
    }
    for (std::uint32_t i = 0; i < run_width; ++i) {
      // Of a run with itself: each segment with those after it.
      const std::uint32_t wanted =
          first_bits(span_b.segment_count) & ~(same ? first_bits(i + 1) : 0U);
      near_bits[i] = static_cast<std::uint8_t>(near_bits[i] & wanted);
    }
    const bool more = sink_.offer(span_a, span_b, near_bits);
    bound_ = sink_.bound();
    return more;
  }

  /// Adds bits of the segments of b from `lane` on that come near each of a's; returns all of them.
  static std::uint32_t near_segments(const Run& a, std::uint32_t count_a, const Run& b,
                                     std::size_t lane, float reach,
                                     std::uint8_t (&near_bits)[run_width]) {
    const Floats d;
    const auto reaches = hn::Set(d, reach);
    const LaneVector start{hn::LoadU(d, b.x + lane), hn::LoadU(d, b.y + lane),
                           hn::LoadU(d, b.z + lane)};
    const LaneVector end{hn::LoadU(d, b.x + lane + 1), hn::LoadU(d, b.y + lane + 1),
                         hn::LoadU(d, b.z + lane + 1)};
    const LaneSegments segments = lane_segments(start, end);
    const LaneVector lower = subtract(minimum(start, end), {reaches, reaches, reaches});
    const LaneVector upper = add(maximum(start, end), {reaches, reaches, reaches});
    std::uint32_t any = 0;
    for (std::uint32_t i = 0; i < count_a; ++i) {
      const LaneVector p0{hn::Set(d, a.x[i]), hn::Set(d, a.y[i]), hn::Set(d, a.z[i])};
      const LaneVector p1{hn::Set(d, a.x[i + 1]), hn::Set(d, a.y[i + 1]), hn::Set(d, a.z[i + 1])};
      const auto apart = boxes_apart(minimum(p0, p1), maximum(p0, p1), lower, upper);
      if (hn::AllTrue(d, apart)) {
        continue;
      }
      const auto close = hn::AndNot(apart, near(lane_segments(p0, p1), segments, reaches));
      const std::uint32_t bits = bits_of(close) << lane;
      near_bits[i] = static_cast<std::uint8_t>(near_bits[i] | bits);
      any |= bits;
    }
    return any;
  }

  void count(std::uint32_t tests, std::uint32_t bits) {
    counts_.node_tests += tests;
    counts_.node_overlaps += hwy::PopCount(bits);
  }

  const RunTreeView& a_;
  const RunTreeView& b_;
  const bool self_;
  PairSink& sink_;
  QueryCounts& counts_;
  float bound_;
};

bool FindNearRuns(const RunTreeView& a, std::uint32_t begin, std::uint32_t end,
                  const RunTreeView& b, PairSink& sink, QueryCounts& counts) {
  Finder finder(a, b, sink, counts);
  for (std::uint32_t group = begin; group < end; ++group) {
    if (!finder.find(group)) {
      return false;
    }
  }
  return true;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(FitGroups);
HWY_EXPORT(FindNearRuns);

void fit_groups(const FiberAssembly& fibers, const Eigen::Vector3d& origin, const RunSpan* spans,
                std::uint32_t run_count, std::uint32_t begin, std::uint32_t end, Run* runs,
                ChordBlock* chords, BoxBlock* boxes) {
  HWY_DYNAMIC_DISPATCH(FitGroups)
  (fibers, origin, spans, run_count, begin, end, runs, chords, boxes);
}

bool find_near_runs(const RunTreeView& a, std::uint32_t begin, std::uint32_t end,
                    const RunTreeView& b, PairSink& sink, QueryCounts& counts) {
  return HWY_DYNAMIC_DISPATCH(FindNearRuns)(a, begin, end, b, sink, counts);
}

}  // namespace fiber
#endif
