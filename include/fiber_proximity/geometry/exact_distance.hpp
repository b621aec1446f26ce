#pragma once

#include <Eigen/Core>
#include <cmath>

#include "fiber_proximity/geometry/segment_distance.hpp"

namespace fiber {

/// Closest points of the segments p0–p1 and q0–q1 [m], computed in integers: all coordinates are
/// multiples of one power of two. Distance, parameters and delta are the doubles nearest to the
/// exact ones; the error is one unit in the last place of the distance, or 0 where it is exact.
/// About a thousand times as slow as segment_distance(). Valid up to
/// FiberAssembly::max_coordinate, subnormal numbers included.
SegmentDistance exact_segment_distance(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                                       const Eigen::Vector3d& q0, const Eigen::Vector3d& q1);

/// The same distance, rounded to the nearest double, in a few times the time of a robust one that
/// is already there: numbers of twice a double's digits mostly prove how it is rounded, integers
/// do where they do not. Then parameters and delta are exact as well; mostly they stay robust.
SegmentDistance rounded_segment_distance(const SegmentDistance& robust, const Eigen::Vector3d& p0,
                                         const Eigen::Vector3d& p1, const Eigen::Vector3d& q0,
                                         const Eigen::Vector3d& q1);

/// What makes two capsules a contact: their axes are at most the sum of these three apart. Answers
/// are about the sum itself, not about what it is rounded to.
struct ContactLimit {
  double radius_a = 0.0;  ///< [m] >= 0
  double radius_b = 0.0;  ///< [m] >= 0
  double margin = 0.0;    ///< [m] finite; infinity for no limit

  /// [m] The sum in numbers of this kind, rounded by less than 2⁻⁵² of parts(), or what is as much
  /// for them.
  template <class Number = double>
  Number sum() const {
    return Number(radius_a) + Number(radius_b) + Number(margin);
  }

  /// [m] The same, all counted positive: where a margin below 0 cancels, the sum is less.
  template <class Number = double>
  Number parts() const {
    return Number(radius_a) + Number(radius_b) + Number(std::abs(margin));
  }
};

/// Whether the segments' exact distance is at most the exact limit; no rounding anywhere.
bool exact_gap_at_most(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                       const Eigen::Vector3d& q0, const Eigen::Vector3d& q1,
                       const ContactLimit& limit);

/// The same answer, mostly from the robust distance and what is proven of its error. What that
/// leaves open is decided by numbers of twice the digits, and what these leave open by integers.
bool gap_at_most(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1, const Eigen::Vector3d& q0,
                 const Eigen::Vector3d& q1, const ContactLimit& limit);

/// The same for a robust distance [m] that is already there.
bool gap_at_most(const SegmentDistance& robust, const Eigen::Vector3d& p0,
                 const Eigen::Vector3d& p1, const Eigen::Vector3d& q0, const Eigen::Vector3d& q1,
                 const ContactLimit& limit);

}  // namespace fiber
