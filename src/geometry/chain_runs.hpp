#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace fiber {

/// Where a point lies beside the axis from a by u, of squared length uu: 0 at a, 1 at its end.
inline double projection(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                         const Eigen::Vector3d& u, double uu) {
  return uu > 0.0 ? (point - a).dot(u) / uu : 0.0;
}

/// [m] At least the distance of the points between begin and end from the line segment of these
/// two; infinite if that is more than the limit.
inline double deviation_of_points(const std::vector<Eigen::Vector3d>& points, std::uint32_t begin,
                                  std::uint32_t end, double limit) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d& a = points[begin];
  const Eigen::Vector3d u = points[end] - a;
  const double uu = u.squaredNorm();
  double squared = 0.0;
  for (std::uint32_t i = begin + 1; i < end; ++i) {
    const double t = std::clamp(projection(points[i], a, u, uu), 0.0, 1.0);
    squared = std::max(squared, ((a - points[i]) + t * u).squaredNorm());
    if (squared > limit * limit) {
      return infinity;
    }
  }
  // Any t gives a distance that is too large if anything. What is computed of it errs by fewer than
  // 20 units of 2⁻⁵³ of |a − p| + |u|, and |a − p| is at most |u| and the distance. Squares that
  // underflow hide less than 2⁻⁵³⁶.
  const double distance = std::sqrt(squared);
  const double bound = distance + 0x1p-46 * (std::sqrt(uu) + distance) + 0x1p-536;
  return bound <= limit ? bound : infinity;
}

/// A long run of consecutive segments that one may replace: of twice as many each time until one is
/// too long, then the longest between the last two that bisection finds. That it is the longest of
/// all would take the square of its length to prove.
/// @param most     segments at most, at least 1
/// @param fits     whether this many segments, at least 2, may be replaced
/// @return how many: 1, or the largest for which `fits` was asked and true
template <class Fits>
std::uint32_t long_run(std::uint32_t most, const Fits& fits) {
  std::uint32_t fitting = 1;
  std::uint32_t too_long = most + 1;
  for (std::uint32_t count = 2; count < too_long; count = std::min(2 * count, most)) {
    if (!fits(count)) {
      too_long = count;
    } else if (count == most) {
      return count;
    } else {
      fitting = count;
    }
  }
  while (fitting + 1 < too_long) {
    const std::uint32_t count = (fitting + too_long) / 2;
    (fits(count) ? fitting : too_long) = count;
  }
  return fitting;
}

}  // namespace fiber
