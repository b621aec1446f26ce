#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/geometry/segment_distance.hpp"
#include "src/geometry/norm.hpp"

namespace fiber {

/// A place on a segment, as the sum of its nearer end and the way from there: what is near the end
/// is then known to all digits.
struct LoopPlace {
  Eigen::Vector3d end;
  Eigen::Vector3d way;
};

inline LoopPlace place_on(const Capsule& segment, double s) {
  return s <= 0.5 ? LoopPlace{segment.p0, s * (segment.p1 - segment.p0)}
                  : LoopPlace{segment.p1, (1.0 - s) * (segment.p0 - segment.p1)};
}

/// How far points are from a place, by a limit [m], in units in which squares keep their digits.
class LoopReach {
 public:
  LoopReach(const LoopPlace& place, double limit)
      : place_(place),
        scale_(limit > min_safe_norm ? 1.0 : tiny_vector_scale),
        limit_(scale_ * limit) {}

  double scale() const { return scale_; }
  double scaled_limit() const { return limit_; }

  Eigen::Vector3d scaled_way_to(const Eigen::Vector3d& point) const {
    return scale_ * ((point - place_.end) - place_.way);
  }
  bool is_beyond(double scaled_squared) const { return scaled_squared > limit_ * limit_; }
  bool is_beyond(const Eigen::Vector3d& point) const {
    return is_beyond(scaled_way_to(point).squaredNorm());
  }

  /// Whether it is certain that no point of the box is beyond the limit.
  bool holds(const Eigen::AlignedBox3d& box) const {
    // Sums and products are monotonic, roundings included: of no point more comes out.
    const Eigen::Vector3d most =
        scaled_way_to(box.min()).cwiseAbs().cwiseMax(scaled_way_to(box.max()).cwiseAbs());
    return !is_beyond(most.squaredNorm());
  }

 private:
  const LoopPlace& place_;
  const double scale_;
  const double limit_;
};

/// How many questions the rule asks at most.
constexpr int loop_question_count = 4;

/// How far from two places a way between two segments must go to make a loop.
class LoopLimit {
 public:
  LoopLimit(const Capsule& a, const Capsule& b)
      : length_a_(norm_of(a.p1 - a.p0)),
        length_b_(norm_of(b.p1 - b.p0)),
        // The rounding of places on segments makes no loop.
        allowance_(count_of_radii * std::max(a.radius, b.radius) +
                   0x1p-48 * (length_a_ + length_b_)) {}

  /// @param distance of the two places [m]
  double operator()(double distance) const { return part_of_distance * distance + allowance_; }

  double longer_length() const { return std::max(length_a_, length_b_); }

 private:
  static constexpr double part_of_distance = 1.25;
  static constexpr double count_of_radii = 2.5;
  const double length_a_;  // [m]
  const double length_b_;  // [m]
  const double allowance_;
};

/// The ends of two segments that a way from one to the other does not come by: along a fibre, the
/// first one of the segment of the smaller index and the last one of the other.
struct OuterEnds {
  bool is_last_of_a = false;
  bool is_last_of_b = true;
};

/// The rule of LoopTest: whether a way from one segment to another, which along a fibre is the one
/// of the larger index, makes a loop.
/// @param nearest of the kernel robust
/// @param is_left whether any point on the way, the inner ends of both segments included, is
///                further from one of two places than a limit [m]: is_left(question, x, y, limit).
///                Questions count from 0 and come in this order; not all need be asked
template <class IsLeft>
bool makes_loop_by(const Capsule& a, const Capsule& b, const SegmentDistance& nearest,
                   const IsLeft& is_left, OuterEnds outer = {}) {
  const LoopLimit limit(a, b);
  const LoopPlace on_a = place_on(a, nearest.s);
  const LoopPlace on_b = place_on(b, nearest.t);
  const double nearest_limit = limit(nearest.distance);
  // Other places on the segments are no further from these than the longer segment.
  const double limit_for_all = nearest_limit - limit.longer_length();
  if (limit_for_all > 0.0 && !is_left(0, on_a, on_b, limit_for_all)) {
    return false;
  }
  if (is_left(1, on_a, on_b, nearest_limit)) {
    return true;
  }
  const double most = nearest.distance + std::max(a.radius, b.radius);
  const Eigen::Vector3d& end_a = outer.is_last_of_a ? a.p1 : a.p0;
  const SegmentDistance of_a = segment_distance(end_a, end_a, b.p0, b.p1);
  if (of_a.distance <= most && is_left(2, place_on(a, outer.is_last_of_a ? 1.0 : 0.0),
                                       place_on(b, of_a.t), limit(of_a.distance))) {
    return true;
  }
  const Eigen::Vector3d& end_b = outer.is_last_of_b ? b.p1 : b.p0;
  const SegmentDistance of_b = segment_distance(a.p0, a.p1, end_b, end_b);
  return of_b.distance <= most &&
         is_left(3, place_on(a, of_b.s), place_on(b, outer.is_last_of_b ? 1.0 : 0.0),
                 limit(of_b.distance));
}

}  // namespace fiber
