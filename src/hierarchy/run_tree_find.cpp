// Compiled once per instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/hierarchy/run_tree_find.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>

#include "fiber_proximity/hierarchy/run_tree_kernels.hpp"
#include "src/hierarchy/segment_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

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

/// Bits of the block's lanes whose boxes come within the bound of the box in one lane of another.
/// Infinite boxes are near everything.
std::uint32_t near_boxes(const BoxBlock& block, const BoxBlock& other, std::uint32_t other_lane,
                         float bound) {
  const Floats d;
  const LaneVector bounds{hn::Set(d, bound), hn::Set(d, bound), hn::Set(d, bound)};
  const LaneVector lower = subtract(spread(other.lower, other_lane), bounds);
  const LaneVector upper = add(spread(other.upper, other_lane), bounds);
  std::uint32_t bits = 0;
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(d)) {
    const auto apart = boxes_apart(load(block.lower, lane), load(block.upper, lane), lower, upper);
    bits |= bits_of(hn::Not(apart)) << lane;
  }
  return bits;
}

/// The same of capsules.
std::uint32_t near_capsules(const CapsuleBlock& block, const CapsuleBlock& other,
                            std::uint32_t other_lane, float bound) {
  const Floats d;
  const LaneSegments axis =
      lane_segments(spread(other.start, other_lane), spread(other.end, other_lane));
  const auto reach = hn::Set(d, other.radius[other_lane] + bound);
  std::uint32_t bits = 0;
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(d)) {
    const LaneSegments axes = lane_segments(load(block.start, lane), load(block.end, lane));
    bits |= bits_of(near(axis, axes, hn::Add(reach, load(block.radius, lane)))) << lane;
  }
  return bits;
}

LaneVector load_starts(const Run& run, std::size_t lane) {
  const Floats d;
  return {hn::LoadU(d, run.x + lane), hn::LoadU(d, run.y + lane), hn::LoadU(d, run.z + lane)};
}

LaneVector load_ends(const Run& run, std::size_t lane) {
  const Floats d;
  return {hn::LoadU(d, run.x + lane + 1), hn::LoadU(d, run.y + lane + 1),
          hn::LoadU(d, run.z + lane + 1)};
}

/// Bits of the run's segments whose boxes come within the bound of the box of another run.
std::uint32_t near_box_of_run(const Run& run, const BoxBlock& block, std::uint32_t block_lane,
                              float bound) {
  const Floats d;
  const auto reach = hn::Set(d, run.radius + bound);
  const LaneVector reaches{reach, reach, reach};
  const LaneVector lower = subtract(spread(block.lower, block_lane), reaches);
  const LaneVector upper = add(spread(block.upper, block_lane), reaches);
  std::uint32_t bits = 0;
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(d)) {
    const LaneVector start = load_starts(run, lane);
    const LaneVector end = load_ends(run, lane);
    const auto apart = boxes_apart(minimum(start, end), maximum(start, end), lower, upper);
    bits |= bits_of(hn::Not(apart)) << lane;
  }
  return bits;
}

/// Adds bits of the segments of b from `lane` on that come near each of the chosen ones of a;
/// returns all of them.
std::uint32_t near_segments(const Run& a, std::uint32_t chosen, const Run& b, std::size_t lane,
                            float reach, std::uint8_t (&near_bits)[run_width]) {
  const Floats d;
  const auto reaches = hn::Set(d, reach);
  const LaneVector start = load_starts(b, lane);
  const LaneVector end = load_ends(b, lane);
  const LaneSegments segments = lane_segments(start, end);
  const LaneVector lower = subtract(minimum(start, end), {reaches, reaches, reaches});
  const LaneVector upper = add(maximum(start, end), {reaches, reaches, reaches});
  std::uint32_t any = 0;
  while (chosen != 0) {
    const std::uint32_t i = take_lowest(chosen);
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

/// All pairs of the groups of one tree and the runs of another, or of the same.
class Finder {
 public:
  Finder(const RunTreeView& a, const RunTreeView& b, PairSink& sink, QueryCounts& counts)
      : a_(a), b_(b), self_(a.runs == b.runs), sink_(sink), counts_(counts), bound_(sink.bound()) {}

  /// Whether to go on.
  bool find(std::uint32_t group) {
    // Near runs first: those of the group itself.
    if (self_ && !visit_group(group, group, child_bits(a_.levels[0], group))) {
      return false;
    }
    return a_.level_count == 1 ? visit_all(group) : descend(group);
  }

 private:
  struct Node {
    std::uint32_t level;
    std::uint32_t index;
  };

  /// For the one group of a tree that has no level above it.
  bool visit_all(std::uint32_t group) {
    for (std::uint32_t other = self_ ? group + 1 : 0; other < b_.group_count(); ++other) {
      if (!visit_group(group, other, child_bits(b_.levels[0], other))) {
        return false;
      }
    }
    return true;
  }

  bool descend(std::uint32_t group) {
    Node stack[RunTreeView::most_levels * run_width];
    std::uint32_t size = 0;
    stack[size++] = {b_.level_count - 1, 0};
    while (size > 0) {
      const Node node = stack[--size];
      std::uint32_t bits = near_children(node.level, node.index, 1, group);
      if (node.level == 0) {
        const bool again = self_ && node.index == group;
        if (bits != 0 && !again && !visit_group(group, node.index, bits)) {
          return false;
        }
        continue;
      }
      while (bits != 0) {
        const std::uint32_t child = node.index * run_width + take_lowest(bits);
        // Of a tree with itself, each pair of groups once: later ones only.
        const std::uint64_t groups_end = std::uint64_t{child + 1} << (3U * (node.level - 1));
        if (!self_ || groups_end > group + 1) {
          stack[size++] = {node.level - 1, child};
        }
      }
    }
    return true;
  }

  /// Bits of the children of a node of b that come near one child of a level of a.
  std::uint32_t near_children(std::uint32_t level_b, std::uint32_t b, std::uint32_t level_a,
                              std::uint32_t child_a) {
    const RunTreeLevel& of_a = a_.levels[level_a];
    const RunTreeLevel& of_b = b_.levels[level_b];
    const std::uint32_t a = child_a / run_width;
    const std::uint32_t lane = child_a % run_width;
    std::uint32_t bits =
        child_bits(of_b, b) & near_boxes(of_b.boxes[b], of_a.boxes[a], lane, bound_);
    counts_.node_tests += run_width;
    if (bits != 0) {
      bits &= near_capsules(of_b.capsules[b], of_a.capsules[a], lane, bound_);
      counts_.node_overlaps += hwy::PopCount(bits);
    }
    return bits;
  }

  /// Pairs of runs of group g of a and of the chosen lanes of group h of b.
  bool visit_group(std::uint32_t g, std::uint32_t h, std::uint32_t chosen) {
    const bool same = self_ && g == h;
    std::uint32_t rows = child_bits(a_.levels[0], g);
    while (rows != 0) {
      const std::uint32_t row = take_lowest(rows);
      // Of a group with itself: a run with itself, and with those after it.
      const std::uint32_t wanted = same ? chosen & ~first_bits(row) : chosen;
      std::uint32_t bits = wanted & near_children(0, h, 0, g * run_width + row);
      while (bits != 0) {
        if (!visit_runs(g * run_width + row, h * run_width + take_lowest(bits))) {
          return false;
        }
      }
    }
    return true;
  }

  bool visit_runs(std::uint32_t a, std::uint32_t b) {
    const RunSpan& span_a = a_.spans[a];
    const RunSpan& span_b = b_.spans[b];
    const Run& run_a = a_.runs[a];
    const Run& run_b = b_.runs[b];
    const std::uint32_t rows =
        first_bits(span_a.segment_count) &
        near_box_of_run(run_a, b_.levels[0].boxes[b / run_width], b % run_width, bound_);
    if (rows == 0 ||
        near_box_of_run(run_b, a_.levels[0].boxes[a / run_width], a % run_width, bound_) == 0) {
      return true;
    }
    const float reach = run_a.radius + run_b.radius + bound_;
    std::uint8_t near_bits[run_width] = {};
    std::uint32_t any = 0;
    for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(Floats())) {
      any |= near_segments(run_a, rows, run_b, lane, reach, near_bits);
    }
    if (any == 0) {
      return true;
    }
    const bool same = self_ && a == b;
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

HWY_EXPORT(FindNearRuns);

bool find_near_runs(const RunTreeView& a, std::uint32_t begin, std::uint32_t end,
                    const RunTreeView& b, PairSink& sink, QueryCounts& counts) {
  return HWY_DYNAMIC_DISPATCH(FindNearRuns)(a, begin, end, b, sink, counts);
}

}  // namespace fiber
#endif
