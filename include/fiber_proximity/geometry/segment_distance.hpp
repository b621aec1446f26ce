#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace fiber {

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

/// The same, bit for bit, of many pairs at once: of the segments a[i][0]–a[i][1] and
/// b[i][0]–b[i][1].
/// @param distances of the `count` pairs
void segment_distances(const Eigen::Vector3d* const* a, const Eigen::Vector3d* const* b,
                       std::size_t count, SegmentDistance* distances);

/// Of one pair, by the kernel of choice.
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
constexpr double least_distance_scale = 0x1p-100;
constexpr double largest_distance_scale = 0x1p200;

}  // namespace fiber
