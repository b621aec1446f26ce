#include "src/query/graph_neighbours.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "src/geometry/fiber_graph.hpp"
#include "src/query/joint_marks.hpp"

namespace fiber {
namespace {

/// A joint, and what the way to it costs; of equal costs the smaller joint comes first.
template <class Cost>
using ReachedJoint = std::pair<Cost, std::uint32_t>;

/// Joints that are reached and not yet left, the nearest one first; searches of one thread share
/// its memory.
template <class Cost>
class NearestJoints {
 public:
  static NearestJoints& cleared() {
    thread_local NearestJoints joints;
    joints.heap_.clear();
    return joints;
  }

  void push(const ReachedJoint<Cost>& joint) {
    heap_.push_back(joint);
    std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
  }
  bool empty() const { return heap_.empty(); }
  ReachedJoint<Cost> pop() {
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
    const ReachedJoint<Cost> joint = heap_.back();
    heap_.pop_back();
    return joint;
  }

 private:
  std::vector<ReachedJoint<Cost>> heap_;
};

/// The joints that a segment's ends come to first, with what the ways there cost.
template <class Cost, class CostBetween>
class JointsBeside {
 public:
  JointsBeside(const FiberGraph& graph, std::uint32_t segment, const CostBetween& cost) {
    const std::vector<FiberGraph::JointPoint>& points = graph.joint_points();
    if (const std::uint32_t index = graph.last_until(segment); index != FiberGraph::none) {
      joints_[count_++] = {cost(points[index].point, segment), points[index].joint};
    }
    if (const std::uint32_t index = graph.next_from(segment + 1); index != FiberGraph::none) {
      joints_[count_++] = {cost(segment + 1, points[index].point), points[index].joint};
    }
  }
  const ReachedJoint<Cost>* begin() const { return joints_.data(); }
  const ReachedJoint<Cost>* end() const { return joints_.data() + count_; }

 private:
  std::array<ReachedJoint<Cost>, 2> joints_{};
  std::size_t count_ = 0;
};

/// Whether the cheapest way through joints from one segment to the other is near, by Dijkstra.
/// @param cost    of the way between two points of one fibre, the first one first: cost(p, q)
/// @param is_near whether a way of this cost is; what is not makes no longer one near
template <class Cost, class CostBetween, class IsNear>
bool are_near(const FiberGraph& graph, PointPair pair, const CostBetween& cost,
              const IsNear& is_near) {
  const JointsBeside<Cost, CostBetween> from(graph, pair.a, cost);
  const JointsBeside<Cost, CostBetween> to(graph, pair.b, cost);
  const auto is_beside = [&](const ReachedJoint<Cost>& joint) { return is_near(joint.first); };
  if (std::none_of(from.begin(), from.end(), is_beside) ||
      std::none_of(to.begin(), to.end(), is_beside)) {
    return false;
  }
  NearestJoints<Cost>& waiting = NearestJoints<Cost>::cleared();
  JointMarks& left = JointMarks::cleared(graph.joint_count());
  for (const ReachedJoint<Cost>& joint : from) {
    waiting.push(joint);
  }
  const std::vector<FiberGraph::JointPoint>& points = graph.joint_points();
  while (!waiting.empty()) {
    const auto [reached, joint] = waiting.pop();
    if (!is_near(reached)) {
      return false;
    }
    if (left.is_marked(joint)) {
      continue;
    }
    left.mark(joint);
    for (const auto& [rest, last] : to) {
      if (last == joint && is_near(reached + rest)) {
        return true;
      }
    }
    for (const std::uint32_t member : graph.members(joint)) {
      if (member > 0 && graph.has_next(member - 1)) {
        waiting.push({reached + cost(points[member - 1].point, points[member].point),
                      points[member - 1].joint});
      }
      if (graph.has_next(member)) {
        waiting.push({reached + cost(points[member].point, points[member + 1].point),
                      points[member + 1].joint});
      }
    }
  }
  return false;
}

}  // namespace

bool are_near_by_count(const FiberAssembly& fibers, PointPair pair, std::uint32_t max_difference) {
  const FiberGraph& graph = *fibers.graph();
  if (max_difference == 0 || !graph.may_be_near(pair.a, max_difference - 1) ||
      !graph.may_be_near(pair.b, max_difference - 1)) {
    return false;
  }
  // Counts beyond those of all points are as many, and sums of some stay in range.
  const auto cost = [](std::uint32_t p, std::uint32_t q) { return std::uint64_t{q} - p; };
  return are_near<std::uint64_t>(graph, pair, cost,
                                 [&](std::uint64_t count) { return count < max_difference; });
}

bool are_near_by_length(const FiberAssembly& fibers, const std::vector<double>& arc_length,
                        PointPair pair, double length) {
  const auto cost = [&](std::uint32_t p, std::uint32_t q) { return arc_length[q] - arc_length[p]; };
  return are_near<double>(*fibers.graph(), pair, cost,
                          [&](double between) { return between < length; });
}

}  // namespace fiber
