// Compiled once per instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/hierarchy/run_tree_find.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "src/hierarchy/candidates-inl.hpp"
#include "src/hierarchy/probe-inl.hpp"
#include "src/hierarchy/run_lanes-inl.hpp"
#include "src/hierarchy/run_tree_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

constexpr std::uint32_t all_bits = first_bits(run_width);

/// All pairs of the groups of one tree and the segments of another, or of the same.
/// @tparam moves both
template <bool moves>
class Finder {
 public:
  Finder(const RunTreeView& a, const RunTreeView& b, PairSink& sink, std::uint64_t& tests,
         std::uint64_t& overlaps)
      : a_(a),
        b_(b),
        sink_(sink),
        tests_(tests),
        overlaps_(overlaps),
        candidates_(a, b, sink),
        self_(a.runs == b.runs),
        keys_{self_},
        skip_adjacent_(self_ && !sink.wants_adjacent()),
        bound_shrinks_(sink.bound_shrinks()) {}

  /// Whether to go on.
  bool find(std::uint32_t group) {
    const PairBound bound = sink_.bound();
    group_ = group;
    known_ranges_ = 0;
    visited_ = none;
    keys_.bound = bound.key;
    if (HWY_UNLIKELY(keys_.are_bounded()) &&
        children_by_key({b_.level_count - 1, 0}, a_.min_point(group)) == 0) {
      return true;
    }
    aim(bound.gap);
    return visit_near_ones() && descend();
  }

  /// Offers what waits; whether to go on.
  bool finish() { return candidates_.flush(); }

 private:
  struct Node {
    std::uint32_t level;
    std::uint32_t index;
  };

  static constexpr auto none = static_cast<std::uint32_t>(-1);

  /// In a tree with itself this is the group with itself; in another one, where nothing is known
  /// yet of how near it is, its nearest group, the nearest run of that first: descend() finds the
  /// bound smaller.
  bool visit_near_ones() {
    if (self_) {
      visited_ = group_;
      return visit_group(group_, all_bits);
    }
    if (!std::isinf(bound_)) {
      return true;
    }
    const std::uint32_t run = nearest_run(b_, a_.levels[0].boxes[group_]);
    visited_ = run / run_width;
    const std::uint32_t nearest = 1U << run % run_width;
    return visit_group(visited_, nearest) && settle() &&
           visit_group(visited_, all_bits & ~nearest) && settle();
  }

  // A call of its own: several copies of this and of visit_group() are more code and slower.
  HWY_NOINLINE void aim(float bound) {
    bound_ = bound;
    probe_.aim(a_, group_, bound_);
    span_ = bound_ + longest_way();
    prunes_group_ = self_ && is_smaller_than_bound(probe_.whole(), 0);
    prunes_runs_ = 0;
    for (std::uint32_t run = 0; self_ && run < probe_.run_count(); ++run) {
      prunes_runs_ |= is_smaller_than_bound(probe_.runs(), run) ? 1U << run : 0U;
    }
  }

  /// [m] Half of it, by axis, of the group.
  float longest_way() const {
    float longest = 0.0F;
    for (std::uint32_t run = 0; moves && run < probe_.run_count(); ++run) {
      for (const auto& halves : a_.displacements[group_ * run_width + run].half) {
        for (const float half : halves) {
          longest = std::max(longest, std::abs(half));
        }
      }
    }
    return longest;
  }

  /// Where a group or a run extends over many times the bound and the displacements, few of its
  /// pairs are near: it does not pay to ask which are ruled out.
  /// @param boxes larger by the bound on all sides
  bool is_smaller_than_bound(const BoxBlock& boxes, std::uint32_t lane) const {
    float extent = 0.0F;
    for (int axis = 0; axis < 3; ++axis) {
      extent = std::max(extent, boxes.upper[axis][lane] - boxes.lower[axis][lane]);
    }
    return !(extent > 16.0F * span_);
  }

  /// Whether no segments of the group and of group h are pairs.
  bool is_ruled_out(std::uint32_t h) const {
    const std::uint32_t* const of_a = a_.first_points + std::size_t{group_} * run_width * run_width;
    const std::uint32_t* const of_b = b_.first_points + std::size_t{h} * run_width * run_width;
    const std::uint32_t runs_b = std::min(run_width, b_.levels[0].child_count - h * run_width);
    const auto [min_a, max_a] = std::minmax_element(of_a, of_a + probe_.run_count() * run_width);
    const auto [min_b, max_b] = std::minmax_element(of_b, of_b + runs_b * run_width);
    const PointRange range = sink_.ruled_out_with(std::min(*min_a, *min_b));
    return std::max(*max_a, *max_b) < range.end;
  }

  /// Finds what is ruled out with the segments of a run of the group.
  void know_ranges(std::uint32_t run) {
    known_ranges_ |= 1U << run;
    const std::uint32_t a = group_ * run_width + run;
    for (std::uint32_t bits = segments(a_, a); bits != 0;) {
      const std::uint32_t lane = take_lowest(bits);
      ranges_[run][lane] = sink_.ruled_out_with(a_.first_points[a * run_width + lane]);
    }
  }

  bool descend() {
    Node stack[RunTreeView::max_levels * run_width];
    std::uint32_t size = 0;
    stack[size++] = {b_.level_count - 1, 0};
    while (size > 0) {
      const Node node = stack[--size];
      const RunTreeLevel& level = b_.levels[node.level];
      std::uint32_t bits =
          children(level, node.index) & overlapping(level.boxes[node.index], probe_.whole(), 0);
      count(bits);
      if (HWY_UNLIKELY(keys_.are_bounded())) {
        bits &= children_by_key(node, a_.min_point(group_));
      }
      if (node.level == 0) {
        if (bits != 0 && node.index != visited_ &&
            !(visit_group(node.index, bits) && (!bound_shrinks_ || settle()))) {
          return false;
        }
        continue;
      }
      // Those next along the curve, which are near, are popped first.
      while (bits != 0) {
        const std::uint32_t child = node.index * run_width + take_highest(bits);
        // A tree with itself has each pair of groups once: later ones only.
        const std::uint64_t groups_end = std::uint64_t{child + 1} << (3U * (node.level - 1));
        if (!self_ || groups_end > group_ + 1) {
          stack[size++] = {node.level - 1, child};
        }
      }
    }
    return true;
  }

  /// Pairs of the group's runs and the chosen ones of group h of b.
  HWY_NOINLINE bool visit_group(std::uint32_t h, std::uint32_t chosen) {
    const bool same = self_ && h == group_;
    const RunTreeLevel& runs = b_.levels[0];
    if (prunes_group_ && is_ruled_out(h)) {
      return true;
    }
    chosen &= children(runs, h);
    for (std::uint32_t run = 0; run < probe_.run_count(); ++run) {
      // A group with itself: a run with itself, and with those after it.
      const std::uint32_t wanted = same ? chosen & ~first_bits(run) : chosen;
      std::uint32_t bits = wanted & overlapping(runs.boxes[h], probe_.runs(), run);
      count(bits);
      if (HWY_UNLIKELY(keys_.are_bounded())) {
        bits &= children_by_key({0, h}, a_.levels[0].min_points[group_ * run_width + run]);
      }
      while (bits != 0) {
        if (!visit_runs(run, h, take_lowest(bits))) {
          return false;
        }
      }
    }
    return true;
  }

  /// Pairs of segments of a run of the group and one of b: those of each that are near the other's
  /// box, then each of one with those of the other.
  bool visit_runs(std::uint32_t run, std::uint32_t h, std::uint32_t lane) {
    const std::uint32_t a = group_ * run_width + run;
    const std::uint32_t b = h * run_width + lane;
    std::uint32_t rows =
        segments(a_, a) & overlapping(probe_.segments(run), b_.levels[0].boxes[h], lane);
    if (rows == 0) {
      return true;
    }
    BoxBlock boxes;
    fit_boxes<moves>(b_, b, boxes);
    const std::uint32_t columns = segments(b_, b) & overlapping(boxes, probe_.runs(), run);
    if (columns == 0) {
      return true;
    }
    if (!make_room()) {
      return false;
    }
    if (HWY_UNLIKELY((prunes_runs_ & ~known_ranges_) >> run & 1U)) {
      know_ranges(run);
    }
    const bool same = self_ && a == b;
    while (rows != 0) {
      const std::uint32_t i = take_lowest(rows);
      // A run with itself: each segment with those after it.
      const std::uint32_t wanted = same ? columns & ~first_bits(i + 1) : columns;
      std::uint32_t bits = wanted & overlapping(boxes, probe_.segments(run), i);
      if (bits != 0 && self_) {
        bits &= ~left_out(run, i, b);
      }
      if (HWY_UNLIKELY(keys_.are_bounded())) {
        bits &= keys_.lanes(a_.first_points[a * run_width + i], b_.first_points + b * run_width);
      }
      if (bits != 0) {
        bits &= near_lines<moves>(b_, b, a_, a, i, bound_);
      }
      while (bits != 0) {
        candidates_.push(a * run_width + i, b * run_width + take_lowest(bits));
      }
    }
    return true;
  }

  /// Bits of the segments of run b that are no pairs with that in one lane of a run of the group.
  HWY_INLINE std::uint32_t left_out(std::uint32_t run, std::uint32_t lane, std::uint32_t b) const {
    const std::uint32_t* const first_points = b_.first_points + std::size_t{b} * run_width;
    if (HWY_UNLIKELY((prunes_runs_ >> run & 1U) != 0)) {
      return in_range(first_points, ranges_[run][lane]);
    }
    if (!skip_adjacent_) {
      return 0;
    }
    const std::uint32_t a = group_ * run_width + run;
    return sharing_point(first_points, a_.first_points[a * run_width + lane]);
  }

  /// For the pairs of two runs; the bound may shrink by that. Whether to go on.
  bool make_room() { return candidates_.make_room() && shrink(); }

  /// Offers what waits, for a smaller bound. Whether to go on.
  bool settle() { return candidates_.flush() && shrink(); }

  bool shrink() {
    const PairBound bound = sink_.bound();
    keys_.bound = bound.key;
    if (bound.gap < bound_) {
      aim(bound.gap);
    }
    return true;
  }

  /// Bits of the children of a node of b that may have pairs that matter by their keys with what
  /// has this least first point.
  std::uint32_t children_by_key(Node node, std::uint32_t least) const {
    return keys_.lanes(least,
                       b_.levels[node.level].min_points + std::size_t{run_width} * node.index);
  }

  /// Bits of the children of a node, and of the segments of a run, that there are.
  static std::uint32_t children(const RunTreeLevel& level, std::uint32_t node) {
    return first_bits(std::min(run_width, level.child_count - node * run_width));
  }
  static std::uint32_t segments(const RunTreeView& tree, std::uint32_t run) {
    return first_bits(std::min(run_width, tree.segment_count - run * run_width));
  }

  void count(std::uint32_t bits) {
    tests_ += run_width;
    overlaps_ += hwy::PopCount(bits);
  }

  Probe<moves> probe_;
  const RunTreeView& a_;
  const RunTreeView& b_;
  PairSink& sink_;
  std::uint64_t& tests_;
  std::uint64_t& overlaps_;
  Candidates candidates_;
  std::uint32_t group_ = 0;
  std::uint32_t visited_ = none;  // the group of b that has been visited before the others
  float bound_ = 0.0F;            // [m]
  float span_ = 0.0F;  // [m] the bound, and half of the longest displacement of the group
  const bool self_;
  KeyBound keys_;
  const bool skip_adjacent_;
  const bool bound_shrinks_;
  // Whether to ask if they are ruled out: the group, and by bit its runs.
  bool prunes_group_ = false;
  std::uint32_t prunes_runs_ = 0;
  std::uint32_t known_ranges_ = 0;  // by bit the group's runs whose ranges are
  PointRange ranges_[run_width][run_width];
};

template <bool moves>
bool find_near(const RunTreeView& a, std::uint32_t begin, std::uint32_t end, const RunTreeView& b,
               PairSink& sink, std::uint64_t& tests, std::uint64_t& overlaps) {
  Finder<moves> finder(a, b, sink, tests, overlaps);
  for (std::uint32_t group = begin; group < end; ++group) {
    if (!finder.find(group)) {
      return false;
    }
  }
  return finder.finish();
}

bool find_near_segments_lanes(const RunTreeView& a, std::uint32_t begin, std::uint32_t end,
                              const RunTreeView& b, PairSink& sink, std::uint64_t& tests,
                              std::uint64_t& overlaps) {
  return a.displacements == nullptr ? find_near<false>(a, begin, end, b, sink, tests, overlaps)
                                    : find_near<true>(a, begin, end, b, sink, tests, overlaps);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(find_near_segments_lanes);

bool find_near_segments(const RunTreeView& a, std::uint32_t begin, std::uint32_t end,
                        const RunTreeView& b, PairSink& sink, std::uint64_t& tests,
                        std::uint64_t& overlaps) {
  return b.group_count() == 0 ||
         HWY_DYNAMIC_DISPATCH(find_near_segments_lanes)(a, begin, end, b, sink, tests, overlaps);
}

}  // namespace fiber
#endif
