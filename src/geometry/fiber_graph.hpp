#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/geometry/fiber_topology.hpp"

namespace fiber {

/// The graph of an assembly that has joints: its joints, and between them stretches of fibres.
///
/// A closed fibre is stored with its first point again behind its last one, and its two ends are a
/// joint: so all joints are alike, and the segment that starts at point p ends at point p + 1 as in
/// a chain. Points are those that are stored, except where they are called given.
class FiberGraph {
 public:
  /// A point that is joined with others.
  struct JointPoint {
    std::uint32_t point;
    std::uint32_t given;  ///< its index among the points that were given
    std::uint32_t fiber;
    std::uint32_t joint;  ///< counted from 0, below joint_count()
  };

  /// Indices begin … end - 1 of joint points.
  struct Members {
    const std::uint32_t* first;
    const std::uint32_t* last;
    const std::uint32_t* begin() const { return first; }
    const std::uint32_t* end() const { return last; }
  };

  /// The graph of chains of these points; none where nothing is joined.
  /// @param given_offsets valid ones
  /// @throws std::invalid_argument naming what is wrong, its value and what is allowed
  static std::shared_ptr<const FiberGraph> make(const std::vector<std::uint32_t>& given_offsets,
                                                const FiberTopology& topology);

  /// As it was given.
  const FiberTopology& topology() const { return topology_; }
  const std::vector<std::uint32_t>& given_offsets() const { return given_offsets_; }
  std::size_t given_point_count() const { return given_offsets_.back(); }

  /// With the first points of closed fibres repeated.
  const std::vector<std::uint32_t>& offsets() const { return offsets_; }

  bool is_closed(std::uint32_t fiber) const {
    return !topology_.closed.empty() && topology_.closed[fiber] != 0;
  }

  /// Whether some way leads from one fibre to the other.
  bool are_joined(std::uint32_t fiber_a, std::uint32_t fiber_b) const {
    return components_[fiber_a] == components_[fiber_b];
  }

  std::uint32_t joint_count() const {
    return static_cast<std::uint32_t>(member_begins_.size()) - 1;
  }

  /// All joint points, in the order of points; of closed fibres both ends.
  const std::vector<JointPoint>& joint_points() const { return joint_points_; }

  static constexpr auto none = static_cast<std::uint32_t>(-1);

  /// The index of the nearest joint point of this point's fibre that is this point or comes after
  /// it, or none.
  std::uint32_t next_from(std::uint32_t point) const {
    const std::uint32_t index = first_from_[point];
    return index < joint_points_.size() && offsets_[joint_points_[index].fiber] <= point ? index
                                                                                         : none;
  }

  /// The index of the nearest joint point of this point's fibre that is this point or comes before
  /// it, or none.
  std::uint32_t last_until(std::uint32_t point) const {
    const std::uint32_t index = first_from_[point];
    if (index < joint_points_.size() && joint_points_[index].point == point) {
      return index;
    }
    return index > 0 && point < offsets_[joint_points_[index - 1].fiber + 1] ? index - 1 : none;
  }

  /// Whether there may be a joint point so few points from an end of this segment, or at it; false
  /// if there is none.
  bool may_be_near(std::uint32_t segment, std::uint32_t points) const {
    const std::uint32_t first = segment - std::min(segment, points);
    const std::uint32_t end =
        std::min(segment + 2 + std::min(points, offsets_.back()), offsets_.back());
    return first_from_[first] != first_from_[end];
  }

  /// The joint of a point, or none.
  std::uint32_t joint_of(std::uint32_t point) const {
    const std::uint32_t index = first_from_[point];
    return index == first_from_[point + 1] ? none : joint_points_[index].joint;
  }

  /// Whether an end of one segment is of the same joint as an end of the other.
  bool share_joint(std::uint32_t segment_a, std::uint32_t segment_b) const {
    for (const std::uint32_t point : {segment_a, segment_a + 1}) {
      const std::uint32_t joint = joint_of(point);
      if (joint != none && (joint == joint_of(segment_b) || joint == joint_of(segment_b + 1))) {
        return true;
      }
    }
    return false;
  }

  /// The joint points of a joint.
  Members members(std::uint32_t joint) const {
    return {members_.data() + member_begins_[joint], members_.data() + member_begins_[joint + 1]};
  }

  /// Whether the joint point of the next index is of the same fibre as the one of this.
  bool has_next(std::uint32_t index) const {
    return index + 1 < joint_points_.size() &&
           joint_points_[index].fiber == joint_points_[index + 1].fiber;
  }

  /// Makes items of points that were given those of points that are stored, in place.
  template <class Item>
  void repeat_first_points(std::vector<Item>& items) const {
    items.resize(offsets_.back());
    for (std::size_t fiber = offsets_.size() - 1; fiber-- > 0;) {
      const std::uint32_t shift = offsets_[fiber] - given_offsets_[fiber];
      for (std::uint32_t i = given_offsets_[fiber + 1]; shift > 0 && i-- > given_offsets_[fiber];) {
        items[i + shift] = items[i];
      }
      if (is_closed(static_cast<std::uint32_t>(fiber))) {
        items[offsets_[fiber + 1] - 1] = items[offsets_[fiber]];
      }
    }
  }

  /// The items of points that were given, of those of points that are stored.
  template <class Item>
  std::vector<Item> given(const std::vector<Item>& items) const {
    std::vector<Item> found;
    found.reserve(given_point_count());
    for (std::size_t fiber = 0; fiber + 1 < offsets_.size(); ++fiber) {
      const auto begin = items.begin() + offsets_[fiber];
      found.insert(found.end(), begin, begin + (given_offsets_[fiber + 1] - given_offsets_[fiber]));
    }
    return found;
  }

  /// A closed fibre needs so many points, each given once.
  static constexpr std::uint32_t min_closed_points = 3;

  /// The message for a closed fibre that has fewer.
  static std::string error_of_closed(std::uint64_t fiber, std::uint64_t point_count);

  /// @throws std::invalid_argument for a joint_tolerance below 0 [m]
  static void require_tolerance(const std::optional<double>& joint_tolerance);

  /// @throws std::invalid_argument for a closed fibre whose repeated point is not its first one
  static void require_repeated(std::uint64_t fiber, const Eigen::Vector3d& first,
                               const Eigen::Vector3d& repeated);

  /// @param fibers  of this graph, whose radii count
  /// @param points  [m] where they are now, those that were given or those that are stored
  /// @param numbers what fibres are called in a message, by fibre; empty: as they are counted
  /// @throws std::invalid_argument for points of a joint that do not lie within its tolerance, and
  ///         for a closed fibre whose repeated point is not its first one
  void require_joints_meet(const FiberAssembly& fibers, const std::vector<Eigen::Vector3d>& points,
                           const std::vector<std::uint64_t>& numbers = {}) const;

 private:
  FiberGraph(const std::vector<std::uint32_t>& given_offsets, const FiberTopology& topology);

  void find_joints();
  void find_components();
  double allowed_distance(const FiberAssembly& fibers, std::uint32_t joint,
                          double largest_coordinate) const;

  FiberTopology topology_;
  std::vector<std::uint32_t> given_offsets_;
  std::vector<std::uint32_t> offsets_;
  std::vector<JointPoint> joint_points_;  // by point
  // By point, and behind the last, the index of the first joint point that is this one or comes
  // after it, of whatever fibre.
  std::vector<std::uint32_t> first_from_;
  std::vector<std::uint32_t> members_;        // by joint, indices of joint points
  std::vector<std::uint32_t> member_begins_;  // by joint, and their end
  std::vector<std::uint32_t> components_;     // by fibre: a fibre of its component
};

/// Whether two graphs of the same offsets, or none, join the same points.
inline bool join_alike(const FiberGraph* x, const FiberGraph* y) {
  return x == y || (x != nullptr && y != nullptr && x->topology().closed == y->topology().closed &&
                    x->topology().joints == y->topology().joints);
}

}  // namespace fiber
