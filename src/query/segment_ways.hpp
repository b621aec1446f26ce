#pragma once

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
  /// @param passes tells whether points first … last of one fibre are passable: passes(first, last)
  template <class Passes>
  bool is_passable(const WayEnds& ends, const Passes& passes) const {
    JointMarks& reached = JointMarks::cleared(graph_.joint_count());
    std::vector<std::uint32_t>& waiting = cleared_joints();
    const auto reach = [&](std::uint32_t joint_point, std::uint32_t first, std::uint32_t last) {
      const std::uint32_t joint = graph_.joint_points()[joint_point].joint;
      if (!reached.is_marked(joint) && passes(first, last)) {
        reached.mark(joint);
        waiting.push_back(joint);
      }
    };
    for_each_stretch(pair_.a, ends.leave_by_first, ends.leave_by_last, reach);
    while (!waiting.empty()) {
      const std::uint32_t joint = waiting.back();
      waiting.pop_back();
      bool arrives = false;
      for_each_stretch(pair_.b, ends.arrive_by_first, ends.arrive_by_last,
                       [&](std::uint32_t joint_point, std::uint32_t first, std::uint32_t last) {
                         arrives = arrives || (graph_.joint_points()[joint_point].joint == joint &&
                                               passes(first, last));
                       });
      if (arrives) {
        return true;
      }
      for (const std::uint32_t member : graph_.members(joint)) {
        if (member > 0) {
          reach_along(member - 1, member - 1, reach);
        }
        reach_along(member, member + 1, reach);
      }
    }
    return false;
  }

 private:
  static std::vector<std::uint32_t>& cleared_joints() {
    thread_local std::vector<std::uint32_t> joints;
    joints.clear();
    return joints;
  }

  /// Calls with the joint points that a segment's ends come to first, and the points on the way.
  template <class Call>
  void for_each_stretch(std::uint32_t segment, bool from_first, bool from_last,
                        const Call& call) const {
    const std::vector<FiberGraph::JointPoint>& points = graph_.joint_points();
    const std::uint32_t before = from_first ? graph_.last_until(segment) : FiberGraph::none;
    if (before != FiberGraph::none && is_free(points[before].point, segment)) {
      call(before, points[before].point, segment);
    }
    const std::uint32_t after = from_last ? graph_.next_from(segment + 1) : FiberGraph::none;
    if (after != FiberGraph::none && is_free(segment + 1, points[after].point)) {
      call(after, segment + 1, points[after].point);
    }
  }

  /// Goes to a joint point by the stretch that begins at the one of this index, if there is one.
  template <class Reach>
  void reach_along(std::uint32_t stretch, std::uint32_t joint_point, const Reach& reach) const {
    if (graph_.has_next(stretch)) {
      const std::uint32_t first = graph_.joint_points()[stretch].point;
      const std::uint32_t last = graph_.joint_points()[stretch + 1].point;
      if (is_free(first, last)) {
        reach(joint_point, first, last);
      }
    }
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
