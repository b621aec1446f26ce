#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/geometry/fiber_graph.hpp"
#include "src/query/joint_marks.hpp"

namespace fiber {

/// The points from a segment's end to the joint that a way comes to first there, that one included.
struct WayStretch {
  std::uint32_t joint;
  std::uint32_t joint_point;  ///< the first point or the last
  std::uint32_t first;
  std::uint32_t last;
  bool is_by_last;  ///< of the segment's ends
};

/// The stretches by which ways leave a segment, at most one at each end.
class WayStretches {
 public:
  WayStretches() = default;
  explicit WayStretches(const WayStretch& stretch) { add(stretch); }

  void add(const WayStretch& stretch) { stretches_[count_++] = stretch; }
  template <class Predicate>
  void remove_if(const Predicate& predicate) {
    count_ = static_cast<std::uint32_t>(
        std::remove_if(stretches_.begin(), stretches_.begin() + count_, predicate) -
        stretches_.begin());
  }

  bool is_empty() const { return count_ == 0; }
  const WayStretch* begin() const { return stretches_.data(); }
  const WayStretch* end() const { return stretches_.data() + count_; }

  bool lead_to(std::uint32_t joint) const {
    return std::any_of(begin(), end(),
                       [joint](const WayStretch& stretch) { return stretch.joint == joint; });
  }

 private:
  std::array<WayStretch, 2> stretches_;
  std::uint32_t count_ = 0;
};

/// The ways along a graph from one segment to another that come by a joint and run through neither
/// of the two.
class SegmentWays {
 public:
  SegmentWays(const FiberGraph& graph, PointPair pair) : graph_(graph), pair_(pair) {}

  /// The stretches by which ways may leave the segment of the smaller index, or reach the other.
  WayStretches stretches_of_a() const { return stretches_at(pair_.a); }
  WayStretches stretches_of_b() const { return stretches_at(pair_.b); }

  /// Whether between their joints there is a passable way from one of these stretches to one of
  /// those. Takes time in proportion to what is passable.
  /// @param passable tells which points are: passable.along(first, last) for points of one fibre
  template <class Passable>
  bool some_leads(const WayStretches& from, const WayStretches& to,
                  const Passable& passable) const {
    JointMarks& reached = JointMarks::cleared(graph_.joint_count());
    thread_local std::vector<std::uint32_t> waiting;
    waiting.clear();
    const auto reach = [&](std::uint32_t joint) {
      reached.mark(joint);
      waiting.push_back(joint);
    };
    for (const WayStretch& stretch : from) {
      reach(stretch.joint);
    }
    const std::vector<FiberGraph::JointPoint>& points = graph_.joint_points();
    const auto reach_along = [&](std::uint32_t stretch, std::uint32_t index) {
      if (graph_.has_next(stretch) && !reached.is_marked(points[index].joint) &&
          is_free(points[stretch].point, points[stretch + 1].point) &&
          passable.along(points[stretch].point, points[stretch + 1].point)) {
        reach(points[index].joint);
      }
    };
    while (!waiting.empty()) {
      const std::uint32_t joint = waiting.back();
      waiting.pop_back();
      if (to.lead_to(joint)) {
        return true;
      }
      for (const std::uint32_t member : graph_.members(joint)) {
        if (member > 0) {
          reach_along(member - 1, member - 1);
        }
        reach_along(member, member + 1);
      }
    }
    return false;
  }

 private:
  WayStretches stretches_at(std::uint32_t segment) const {
    const std::vector<FiberGraph::JointPoint>& points = graph_.joint_points();
    WayStretches found;
    const std::uint32_t before = graph_.last_until(segment);
    if (before != FiberGraph::none && is_free(points[before].point, segment)) {
      found.add({points[before].joint, points[before].point, points[before].point, segment, false});
    }
    const std::uint32_t after = graph_.next_from(segment + 1);
    if (after != FiberGraph::none && is_free(segment + 1, points[after].point)) {
      found.add({points[after].joint, points[after].point, segment + 1, points[after].point, true});
    }
    return found;
  }

  /// Whether neither of the two segments is between these points of one fibre.
  bool is_free(std::uint32_t first, std::uint32_t last) const {
    const auto is_between = [&](std::uint32_t segment) {
      return first <= segment && segment < last;
    };
    return !is_between(pair_.a) && !is_between(pair_.b);
  }

  const FiberGraph& graph_;
  const PointPair pair_;
};

}  // namespace fiber
