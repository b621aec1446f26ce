// Compiled once per instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/hierarchy/run_tree_find.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>

#include "fiber_proximity/hierarchy/run_tree_kernels.hpp"
#include "src/hierarchy/candidates-inl.hpp"
#include "src/hierarchy/segment_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

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

/// All pairs of the groups of one tree and the runs of another, or of the same.
class Finder {
 public:
  Finder(const RunTreeView& a, const RunTreeView& b, PairSink& sink, QueryCounts& counts)
      : a_(a),
        b_(b),
        self_(a.runs == b.runs),
        sink_(sink),
        counts_(counts),
        candidates_(a, b, sink),
        bound_(sink.bound()) {}

  /// Whether to go on.
  bool find(std::uint32_t group) {
    // Near runs first: those of the group itself.
    if (self_ && !visit_group(group, group, child_bits(a_.levels[0], group))) {
      return false;
    }
    return a_.level_count == 1 ? visit_all(group) : descend(group);
  }

  /// Offers what waits; whether to go on.
  bool finish() { return candidates_.flush(); }

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
      std::uint32_t bits = near_group(node.level, node.index, group);
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

  /// Bits of the children of a node of b that come near group g of a. Boxes first, then capsules.
  std::uint32_t near_group(std::uint32_t level, std::uint32_t node, std::uint32_t g) {
    const RunTreeLevel& of_a = a_.levels[1];
    const RunTreeLevel& of_b = b_.levels[level];
    const std::uint32_t a = g / run_width;
    const std::uint32_t lane = g % run_width;
    std::uint32_t bits =
        child_bits(of_b, node) & near_boxes(of_b.boxes[node], of_a.boxes[a], lane, bound_);
    if (bits != 0) {
      bits &= near_capsules(of_b.capsules[node], of_a.capsules[a], lane, bound_);
    }
    count(bits);
    return bits;
  }

  /// Pairs of runs of group g of a and of the chosen lanes of group h of b. Of runs, boxes decide:
  /// their capsules would cost more than they save.
  bool visit_group(std::uint32_t g, std::uint32_t h, std::uint32_t chosen) {
    const bool same = self_ && g == h;
    const BoxBlock& boxes_g = a_.levels[0].boxes[g];
    const BoxBlock& boxes_h = b_.levels[0].boxes[h];
    std::uint32_t rows = child_bits(a_.levels[0], g);
    while (rows != 0) {
      const std::uint32_t row = take_lowest(rows);
      // Of a group with itself: a run with itself, and with those after it.
      const std::uint32_t wanted = same ? chosen & ~first_bits(row) : chosen;
      std::uint32_t bits = wanted & near_boxes(boxes_h, boxes_g, row, bound_);
      count(bits);
      while (bits != 0) {
        if (!visit_runs(g * run_width + row, h * run_width + take_lowest(bits))) {
          return false;
        }
      }
    }
    return true;
  }

  void count(std::uint32_t bits) {
    counts_.node_tests += run_width;
    counts_.node_overlaps += hwy::PopCount(bits);
  }

  /// Pairs of segments of two runs: those of each that are near the other's box, then each of one
  /// with those of the other.
  bool visit_runs(std::uint32_t a, std::uint32_t b) {
    const BoxBlock& of_a = a_.segment_boxes[a];
    const BoxBlock& of_b = b_.segment_boxes[b];
    const BoxBlock& with_a = a_.levels[0].boxes[a / run_width];
    const BoxBlock& with_b = b_.levels[0].boxes[b / run_width];
    std::uint32_t rows =
        first_bits(a_.spans[a].segment_count) & near_boxes(of_a, with_b, b % run_width, bound_);
    if (rows == 0) {
      return true;
    }
    const std::uint32_t columns =
        first_bits(b_.spans[b].segment_count) & near_boxes(of_b, with_a, a % run_width, bound_);
    if (columns == 0) {
      return true;
    }
    if (!candidates_.make_room()) {
      return false;
    }
    bound_ = sink_.bound();
    const bool same = self_ && a == b;
    const float reach = a_.runs[a].radius + b_.runs[b].radius + bound_;
    while (rows != 0) {
      const std::uint32_t i = take_lowest(rows);
      // Of a run with itself: each segment with those after it.
      const std::uint32_t wanted = same ? columns & ~first_bits(i + 1) : columns;
      std::uint32_t bits = wanted & near_boxes(of_b, of_a, i, bound_);
      while (bits != 0) {
        candidates_.push(a, i, b, take_lowest(bits), reach);
      }
    }
    return true;
  }

  const RunTreeView& a_;
  const RunTreeView& b_;
  const bool self_;
  PairSink& sink_;
  QueryCounts& counts_;
  Candidates candidates_;
  float bound_;
};

bool find_near_runs_lanes(const RunTreeView& a, std::uint32_t begin, std::uint32_t end,
                          const RunTreeView& b, PairSink& sink, QueryCounts& counts) {
  Finder finder(a, b, sink, counts);
  for (std::uint32_t group = begin; group < end; ++group) {
    if (!finder.find(group)) {
      return false;
    }
  }
  return finder.finish();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(find_near_runs_lanes);

bool find_near_runs(const RunTreeView& a, std::uint32_t begin, std::uint32_t end,
                    const RunTreeView& b, PairSink& sink, QueryCounts& counts) {
  return HWY_DYNAMIC_DISPATCH(find_near_runs_lanes)(a, begin, end, b, sink, counts);
}

}  // namespace fiber
#endif
