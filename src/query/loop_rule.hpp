#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <optional>

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

/// Whether any point on a way is further from one of two places than a limit [m].
struct LoopCriterion {
  LoopPlace x;
  LoopPlace y;
  double limit;
};

/// The criteria by which the rule of LoopTest judges each way from one segment to another.
class LoopCriteria {
 public:
  /// @param nearest of the kernel robust
  LoopCriteria(const Capsule& a, const Capsule& b, const SegmentDistance& nearest)
      : a_(a), b_(b), nearest_(nearest), limit_(a, b) {}

  /// About the places where the segments are nearest: the same of all ways.
  LoopCriterion of_nearest() const {
    return {place_on(a_, nearest_.s), place_on(b_, nearest_.t), limit_(nearest_.distance)};
  }

  /// About an outer end of the first segment and the place of the other that is nearest to it; none
  /// if these are much further apart than the nearest places.
  std::optional<LoopCriterion> of_end_of_a(bool is_last) const {
    const Eigen::Vector3d& end = is_last ? a_.p1 : a_.p0;
    if (is_surely_far(end, b_)) {
      return std::nullopt;
    }
    const SegmentDistance distance = segment_distance(end, end, b_.p0, b_.p1);
    if (distance.distance > reach_of_ends()) {
      return std::nullopt;
    }
    return LoopCriterion{place_on(a_, is_last ? 1.0 : 0.0), place_on(b_, distance.t),
                         limit_(distance.distance)};
  }
  std::optional<LoopCriterion> of_end_of_b(bool is_last) const {
    const Eigen::Vector3d& end = is_last ? b_.p1 : b_.p0;
    if (is_surely_far(end, a_)) {
      return std::nullopt;
    }
    const SegmentDistance distance = segment_distance(a_.p0, a_.p1, end, end);
    if (distance.distance > reach_of_ends()) {
      return std::nullopt;
    }
    return LoopCriterion{place_on(a_, distance.s), place_on(b_, is_last ? 1.0 : 0.0),
                         limit_(distance.distance)};
  }

  /// The criterion, if there is one, that implies all others: other places on the segments are no
  /// further from the nearest ones than the longer segment.
  std::optional<LoopCriterion> of_all() const {
    LoopCriterion criterion = of_nearest();
    criterion.limit -= limit_.longer_length();
    return criterion.limit > 0.0 ? std::make_optional(criterion) : std::nullopt;
  }

 private:
  double reach_of_ends() const { return nearest_.distance + std::max(a_.radius, b_.radius); }

  /// Whether a point is certainly out of reach_of_ends() of a segment. Most are, and this takes a
  /// tenth of what their distance takes.
  bool is_surely_far(const Eigen::Vector3d& point, const Capsule& segment) const {
    const Eigen::Vector3d along = segment.p1 - segment.p0;
    const Eigen::Vector3d way = point - segment.p0;
    const double t = std::clamp(way.dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double squared = (way - t * along).squaredNorm();
    const double reach = reach_of_ends();
    // Roundings are a few parts of 2^53 of the way, unless squares lose digits; what is not a
    // number is not sure.
    return squared > (1.0 + 0x1p-20) * (reach * reach) + 0x1p-40 * way.squaredNorm() &&
           squared > min_safe_norm;
  }

  const Capsule& a_;
  const Capsule& b_;
  const SegmentDistance& nearest_;
  const LoopLimit limit_;
};

/// The rule of LoopTest: whether the way along a fibre from one segment to another, which is the
/// one of the larger index, makes a loop.
/// @param nearest of the kernel robust
/// @param is_left whether any point on the way, the inner ends of both segments included, is
///                further from one of two places than a limit [m]: is_left(question, x, y,
///                limit).
///                Questions count from 0 and come in this order; not all need be asked
template <class IsLeft>
bool makes_loop_by(const Capsule& a, const Capsule& b, const SegmentDistance& nearest,
                   const IsLeft& is_left) {
  const LoopCriteria criteria(a, b, nearest);
  const auto asks = [&is_left](int question, const LoopCriterion& criterion) {
    return is_left(question, criterion.x, criterion.y, criterion.limit);
  };
  const std::optional<LoopCriterion> of_all = criteria.of_all();
  if (of_all && !asks(0, *of_all)) {
    return false;
  }
  if (asks(1, criteria.of_nearest())) {
    return true;
  }
  const std::optional<LoopCriterion> of_end_of_a = criteria.of_end_of_a(false);
  if (of_end_of_a && asks(2, *of_end_of_a)) {
    return true;
  }
  const std::optional<LoopCriterion> of_end_of_b = criteria.of_end_of_b(true);
  return of_end_of_b && asks(3, *of_end_of_b);
}

}  // namespace fiber
