#include "src/geometry/fiber_graph.hpp"

#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "src/geometry/disjoint_sets.hpp"
#include "src/geometry/norm.hpp"

namespace fiber {
namespace {

// In parts of the largest coordinate: what single precision rounds to, and some more.
constexpr double relative_tolerance = 1e-6;

template <class... Parts>
[[noreturn]] void refuse_topology(const Parts&... parts) {
  std::ostringstream message;
  (message << ... << parts);
  throw std::invalid_argument(message.str());
}

void check_sizes(const std::vector<std::uint32_t>& offsets, const FiberTopology& topology) {
  const std::size_t fiber_count = offsets.size() - 1;
  if (!topology.closed.empty() && topology.closed.size() != fiber_count) {
    refuse_topology("closed has ", topology.closed.size(), " value(s) for ", fiber_count,
                    " fibre(s); give none or one per fibre");
  }
  if (!topology.joints.empty() && topology.joints.size() != offsets.back()) {
    refuse_topology("joints has ", topology.joints.size(), " value(s) for ", offsets.back(),
                    " points; give none or one per point");
  }
  FiberGraph::require_tolerance(topology.joint_tolerance);
  for (std::size_t fiber = 0; fiber < topology.closed.size(); ++fiber) {
    const std::uint32_t count = offsets[fiber + 1] - offsets[fiber];
    if (topology.closed[fiber] != 0 && count < FiberGraph::min_closed_points) {
      throw std::invalid_argument(FiberGraph::error_of_closed(fiber, count));
    }
  }
}

/// The points that have a number, sorted by it.
std::vector<std::pair<std::int32_t, std::uint32_t>> numbered_points(
    const std::vector<std::int32_t>& joints) {
  std::vector<std::pair<std::int32_t, std::uint32_t>> points;
  for (std::uint32_t point = 0; point < joints.size(); ++point) {
    if (joints[point] >= 0) {
      points.emplace_back(joints[point], point);
    }
  }
  std::sort(points.begin(), points.end());
  return points;
}

/// Calls with the first and behind the last of the points of each number.
template <class Points, class Call>
void for_each_number(const Points& points, const Call& call) {
  for (auto first = points.begin(); first != points.end();) {
    const auto last = std::find_if(
        first, points.end(), [first](const auto& point) { return point.first != first->first; });
    call(first, last);
    first = last;
  }
}

std::string name_of(const FiberGraph::JointPoint& point,
                    const std::vector<std::uint32_t>& given_offsets,
                    const std::vector<std::uint64_t>& numbers) {
  const std::uint64_t fiber = numbers.empty() ? point.fiber : numbers[point.fiber];
  return "fibre " + std::to_string(fiber) + ", point " +
         std::to_string(point.given - given_offsets[point.fiber]);
}

/// The largest radius of the segments of a fibre that meet at one of its points [m].
double radius_at_joint(const FiberAssembly& fibers, const FiberGraph::JointPoint& point) {
  double radius = 0.0;
  if (point.point > fibers.offsets()[point.fiber]) {
    radius = fibers.segment_radius(point.point - 1);
  }
  if (point.point + 1 < fibers.offsets()[point.fiber + 1]) {
    radius = std::max(radius, fibers.segment_radius(point.point));
  }
  return radius;
}

}  // namespace

std::vector<LonelyJoint> lonely_joints(const std::vector<std::int32_t>& joints) {
  std::vector<LonelyJoint> lonely;
  for_each_number(numbered_points(joints), [&](auto first, auto last) {
    if (last - first == 1) {
      lonely.push_back({first->first, first->second});
    }
  });
  std::sort(lonely.begin(), lonely.end(),
            [](const LonelyJoint& x, const LonelyJoint& y) { return x.point < y.point; });
  return lonely;
}

std::shared_ptr<const FiberGraph> FiberGraph::make(const std::vector<std::uint32_t>& given_offsets,
                                                   const FiberTopology& topology) {
  check_sizes(given_offsets, topology);
  const auto is_set = [](auto value) { return value > 0; };
  if (std::none_of(topology.closed.begin(), topology.closed.end(), is_set) &&
      std::none_of(topology.joints.begin(), topology.joints.end(),
                   [](std::int32_t joint) { return joint >= 0; })) {
    return nullptr;
  }
  const std::shared_ptr<const FiberGraph> graph(new FiberGraph(given_offsets, topology));
  return graph->joint_points_.empty() ? nullptr : graph;
}

FiberGraph::FiberGraph(const std::vector<std::uint32_t>& given_offsets,
                       const FiberTopology& topology)
    : topology_(topology), given_offsets_(given_offsets), offsets_(given_offsets) {
  std::uint32_t repeated = 0;
  for (std::uint32_t fiber = 0; fiber + 1 < offsets_.size(); ++fiber) {
    repeated += is_closed(fiber) ? 1 : 0;
    offsets_[fiber + 1] += repeated;
  }
  find_joints();
  find_components();
}

void FiberGraph::find_joints() {
  std::uint32_t count = 0;
  const auto add = [&](std::uint32_t given) {
    const auto next = std::upper_bound(given_offsets_.begin(), given_offsets_.end(), given);
    const auto fiber = static_cast<std::uint32_t>(next - given_offsets_.begin() - 1);
    const std::uint32_t along = given - given_offsets_[fiber];
    joint_points_.push_back({offsets_[fiber] + along, given, fiber, count});
    if (along == 0 && is_closed(fiber)) {
      joint_points_.push_back({offsets_[fiber + 1] - 1, given, fiber, count});
    }
  };
  for_each_number(numbered_points(topology_.joints), [&](auto first, auto last) {
    if (last - first > 1) {
      std::for_each(first, last, [&](const auto& point) { add(point.second); });
      ++count;
    }
  });
  const auto by_point = [](const JointPoint& x, const JointPoint& y) { return x.point < y.point; };
  std::sort(joint_points_.begin(), joint_points_.end(), by_point);
  const std::size_t numbered = joint_points_.size();
  for (std::uint32_t fiber = 0; fiber + 1 < offsets_.size(); ++fiber) {
    const JointPoint first{offsets_[fiber], 0, fiber, 0};
    const auto end = joint_points_.begin() + static_cast<std::ptrdiff_t>(numbered);
    if (is_closed(fiber) && !std::binary_search(joint_points_.begin(), end, first, by_point)) {
      add(given_offsets_[fiber]);
      ++count;
    }
  }
  std::sort(joint_points_.begin(), joint_points_.end(), by_point);
  member_begins_.assign(count + 1, 0);
  for (const JointPoint& point : joint_points_) {
    ++member_begins_[point.joint + 1];
  }
  std::partial_sum(member_begins_.begin(), member_begins_.end(), member_begins_.begin());
  members_.resize(joint_points_.size());
  std::vector<std::uint32_t> ends(member_begins_.begin(), member_begins_.end() - 1);
  first_from_.resize(offsets_.back() + 1);
  std::uint32_t point = 0;
  for (std::uint32_t index = 0; index < joint_points_.size(); ++index) {
    members_[ends[joint_points_[index].joint]++] = index;
    for (; point <= joint_points_[index].point; ++point) {
      first_from_[point] = index;
    }
  }
  std::fill(first_from_.begin() + point, first_from_.end(),
            static_cast<std::uint32_t>(joint_points_.size()));
}

/// Joins fibres to sets, each known by its smallest fibre.
void FiberGraph::find_components() {
  DisjointSets joined(static_cast<std::uint32_t>(offsets_.size() - 1));
  for (std::uint32_t joint = 0; joint < joint_count(); ++joint) {
    const std::uint32_t first = joint_points_[*members(joint).begin()].fiber;
    for (const std::uint32_t member : members(joint)) {
      joined.join(first, joint_points_[member].fiber);
    }
  }
  joined.find_roots(components_);
}

/// How far the points of this joint may be from its first one [m].
double FiberGraph::allowed_distance(const FiberAssembly& fibers, std::uint32_t joint,
                                    double largest_coordinate) const {
  if (topology_.joint_tolerance) {
    return *topology_.joint_tolerance;
  }
  double allowed = relative_tolerance * largest_coordinate;
  for (const std::uint32_t member : members(joint)) {
    allowed = std::max(allowed, radius_at_joint(fibers, joint_points_[member]));
  }
  return allowed;
}

std::string FiberGraph::error_of_closed(std::uint64_t fiber, std::uint64_t point_count) {
  return "fibre " + std::to_string(fiber) + ": is closed and has " + std::to_string(point_count) +
         " points, a closed fibre needs at least " + std::to_string(min_closed_points);
}

void FiberGraph::require_tolerance(const std::optional<double>& joint_tolerance) {
  if (!(joint_tolerance.value_or(0.0) >= 0.0)) {
    refuse_topology("joint_tolerance is ", *joint_tolerance, " m, it must be at least 0");
  }
}

void FiberGraph::require_repeated(std::uint64_t fiber, const Eigen::Vector3d& first,
                                  const Eigen::Vector3d& repeated) {
  if (first != repeated) {
    refuse_topology("fibre ", fiber, ": is closed, and its first point is repeated ",
                    norm_of(repeated - first), " m away; repeat it where it is, or leave it out");
  }
}

void FiberGraph::require_joints_meet(const FiberAssembly& fibers,
                                     const std::vector<Eigen::Vector3d>& points,
                                     const std::vector<std::uint64_t>& numbers) const {
  const bool are_stored = points.size() == offsets_.back();
  for (std::uint32_t fiber = 0; are_stored && fiber + 1 < offsets_.size(); ++fiber) {
    if (is_closed(fiber)) {
      require_repeated(fiber, points[offsets_[fiber]], points[offsets_[fiber + 1] - 1]);
    }
  }
  const auto at = [&](const JointPoint& point) -> const Eigen::Vector3d& {
    return points[are_stored ? point.point : point.given];
  };
  for (std::uint32_t joint = 0; joint < joint_count(); ++joint) {
    const JointPoint& first = joint_points_[*members(joint).begin()];
    for (const std::uint32_t member : members(joint)) {
      const JointPoint& point = joint_points_[member];
      if (at(point) == at(first)) {
        continue;
      }
      const double distance = norm_of(at(point) - at(first));
      const double allowed = allowed_distance(fibers, joint, at(first).cwiseAbs().maxCoeff());
      if (distance > allowed) {
        refuse_topology("joint ", topology_.joints[first.given], ": ",
                        name_of(first, given_offsets_, numbers), " and ",
                        name_of(point, given_offsets_, numbers), " are ", distance,
                        " m apart; points that are joined must lie within ", allowed, " m, ",
                        topology_.joint_tolerance
                            ? "the joint_tolerance"
                            : "the largest radius that meets there or 1e-6 of the largest "
                              "coordinate");
      }
    }
  }
}

}  // namespace fiber
