#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/geometry/fiber_graph.hpp"
#include "src/query/joint_marks.hpp"

namespace fiber {

/// Which ends of two segments ways lead by: they leave the segment of the smaller index by its
/// first point, its last, or either, and arrive at the other one alike.
struct WayEnds {
  bool leave_by_first = true;
  bool leave_by_last = true;
  bool arrive_by_first = true;
  bool arrive_by_last = true;
};

/// The ways along a graph from one segment to another that come by a joint and run through neither
/// of the two.
class SegmentWays {
 public:
  SegmentWays(const FiberGraph& graph, PointPair pair) : graph_(graph), pair_(pair) {}

  /// Whether there is one that is passable. Takes time in proportion to what is.
  /// @param passable tells which points are: passable.at(point), passable.along(first, last) for
  ///                 points of one fibre
  template <class Passable>
  bool is_passable(const WayEnds& ends, const Passable& passable) const {
    // Nearly all segments are far from all joints: both ends are looked at before any search.
    Stretches from = stretches_at(pair_.a, ends.leave_by_first, ends.leave_by_last, passable);
    if (from.count == 0) {
      return false;
    }
    Stretches to = stretches_at(pair_.b, ends.arrive_by_first, ends.arrive_by_last, passable);
    return leave_passable(from, passable) && leave_passable(to, passable) &&
           some_leads(from, to, passable);
  }

 private:
  /// The points from a segment's end to the joint that it comes to first, that one included.
  struct Stretch {
    std::uint32_t joint;
    std::uint32_t first;
    std::uint32_t last;
  };
  struct Stretches {
    Stretch stretches[2];
    std::uint32_t count = 0;

    bool lead_to(std::uint32_t joint) const {
      return std::any_of(stretches, stretches + count,
                         [joint](const Stretch& stretch) { return stretch.joint == joint; });
    }
  };

  /// Those whose joint point is passable.
  template <class Passable>
  Stretches stretches_at(std::uint32_t segment, bool from_first, bool from_last,
                         const Passable& passable) const {
    const std::vector<FiberGraph::JointPoint>& points = graph_.joint_points();
    Stretches found;
    const auto add = [&](std::uint32_t index, std::uint32_t first, std::uint32_t last) {
      if (is_free(first, last) && passable.at(points[index].point)) {
        found.stretches[found.count++] = {points[index].joint, first, last};
      }
    };
    const std::uint32_t before = from_first ? graph_.last_until(segment) : FiberGraph::none;
    if (before != FiberGraph::none) {
      add(before, points[before].point, segment);
    }
    const std::uint32_t after = from_last ? graph_.next_from(segment + 1) : FiberGraph::none;
    if (after != FiberGraph::none) {
      add(after, segment + 1, points[after].point);
    }
    return found;
  }

  /// Leaves those that are passable; whether any is.
  template <class Passable>
  static bool leave_passable(Stretches& found, const Passable& passable) {
    Stretch* const end = std::remove_if(
        found.stretches, found.stretches + found.count,
        [&](const Stretch& stretch) { return !passable.along(stretch.first, stretch.last); });
    found.count = static_cast<std::uint32_t>(end - found.stretches);
    return found.count > 0;
  }

  template <class Passable>
  bool some_leads(const Stretches& from, const Stretches& to, const Passable& passable) const {
    JointMarks& reached = JointMarks::cleared(graph_.joint_count());
    thread_local std::vector<std::uint32_t> waiting;
    waiting.clear();
    const auto reach = [&](std::uint32_t joint) {
      reached.mark(joint);
      waiting.push_back(joint);
    };
    for (std::uint32_t i = 0; i < from.count; ++i) {
      reach(from.stretches[i].joint);
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
