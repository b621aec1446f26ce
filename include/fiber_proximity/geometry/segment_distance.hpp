#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "fiber_proximity/export.hpp"

namespace FIBER_PROXIMITY_EXPORT fiber {

/// How the distance of two segments is computed; docs/numerics.md has the bounds of each.
enum class Kernel {
  ROBUST,  ///< in double precision
  EXACT    ///< in integers as long as it takes, rounded once at the end
};

/// The kernel of this name: robust or exact.
/// @throws std::invalid_argument listing the names
Kernel kernel_from_name(const std::string& name);

/// All names, in the order of Kernel.
const std::vector<std::string>& kernel_names();

inline const std::string& name_of(Kernel kernel) {
  return kernel_names()[static_cast<std::size_t>(kernel)];
}

/// Closest points of two segments, and how far the distance may be from the true one. The error is
/// that of the kernel: see docs/numerics.md for what is proven of each and what is measured.
struct SegmentDistance {
  double s = 0.0;         ///< parameter on the first segment, 0 at p0 and 1 at p1
  double t = 0.0;         ///< parameter on the second segment, 0 at q0 and 1 at q1
  Eigen::Vector3d delta;  ///< from the point on the first to the point on the second [m]
  double distance = 0.0;  ///< |delta| [m]
  double error = 0.0;     ///< |distance − true distance| is at most this [m]: proven for exact,
                          ///< measured for robust (docs/numerics.md)

  /// [m] The true distance is at least this; never below 0.
  double lower() const {
    if (error == 0.0) {
      return distance;
    }
    const double difference = distance - error;
    return difference > 0.0 ? std::nextafter(difference, 0.0) : 0.0;
  }
  /// [m] The true distance is at most this.
  double upper() const {
    return error > 0.0 ? std::nextafter(distance + error, std::numeric_limits<double>::infinity())
                       : distance;
  }
};

/// Closest points of the segments p0–p1 and q0–q1 [m].
///
/// The minimum of a convex quadratic over the unit square lies at its interior critical point or on
/// an edge, so it is the best of five candidates: the four end points projected onto the other
/// segment, and the interior point with its parameter from cross products alone,
///   s = (v×w)·(u×v) / |u×v|²,  u = p1−p0, v = q1−q0, w = p0−q0,
/// because the textbook numerator b·e − c·d loses half the digits near parallel. Everything is in
/// differences of the input and nothing is compared with an absolute epsilon; parallel, degenerate
/// and coincident segments need no case of their own. Valid for coordinates up to
/// FiberAssembly::max_coordinate; differences whose fourth powers would leave the range of double
/// are scaled by a power of two first.
///
/// The error is robust_error times the largest difference of coordinates along one axis.
SegmentDistance segment_distance(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                                 const Eigen::Vector3d& q0, const Eigen::Vector3d& q1);

/// segment_distance(), bit for bit, of many pairs at once: of the segments a[i][0]–a[i][1] and
/// b[i][0]–b[i][1].
/// @param distances of the `count` pairs
void segment_distances(const Eigen::Vector3d* const* a, const Eigen::Vector3d* const* b,
                       std::size_t count, SegmentDistance* distances);

/// Closest points of one pair, by the kernel of choice.
SegmentDistance segment_distance(Kernel kernel, const Eigen::Vector3d& p0,
                                 const Eigen::Vector3d& p1, const Eigen::Vector3d& q0,
                                 const Eigen::Vector3d& q1);

/// Error of segment_distance() in units of the largest difference of coordinates: four roundings.
/// Measured, not proven: see docs/numerics.md. Proven is proven_robust_error_per_error times as
/// much, which is what decisions rest on.
constexpr double robust_error = 0x1p-50;
constexpr double proven_robust_error_per_error = 12.0;

/// |u×v|² is of the fourth power of the differences: between these magnitudes neither it nor its
/// factors leave the range of double, beyond them everything is scaled to about 1 [m].
constexpr double min_distance_scale = 0x1p-100;
constexpr double largest_distance_scale = 0x1p200;

/// Closest points of the segments p0–p1 and q0–q1 [m], computed in integers: all coordinates are
/// multiples of one power of two. Distance, parameters and delta are the doubles nearest to the
/// exact ones; the error is one unit in the last place of the distance, or 0 where it is exact.
/// About a thousand times as slow as segment_distance(). Valid up to
/// FiberAssembly::max_coordinate, subnormal numbers included.
SegmentDistance exact_segment_distance(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                                       const Eigen::Vector3d& q0, const Eigen::Vector3d& q1);

/// The exact distance, rounded to the nearest double, in a few times the time of a robust one that
/// is already there: numbers of twice a double's digits mostly prove how it is rounded, integers
/// do where they do not. Then parameters and delta are exact as well; mostly they stay robust.
SegmentDistance rounded_segment_distance(const SegmentDistance& robust, const Eigen::Vector3d& p0,
                                         const Eigen::Vector3d& p1, const Eigen::Vector3d& q0,
                                         const Eigen::Vector3d& q1);

/// The limit of a contact of two capsules: axes are at most the sum of these three apart. Answers
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

/// exact_gap_at_most(), mostly from the robust distance and what is proven of its error. What that
/// leaves open is decided by numbers of twice the digits, and what these leave open by integers.
bool gap_at_most(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1, const Eigen::Vector3d& q0,
                 const Eigen::Vector3d& q1, const ContactLimit& limit);

/// gap_at_most() for a robust distance [m] that is already there.
bool gap_at_most(const SegmentDistance& robust, const Eigen::Vector3d& p0,
                 const Eigen::Vector3d& p1, const Eigen::Vector3d& q0, const Eigen::Vector3d& q1,
                 const ContactLimit& limit);

}  // namespace fiber
