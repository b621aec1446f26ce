#include "fiber_proximity/hierarchy/motion_bound.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace fiber {
namespace {

// A range of this many is not split: one thread is faster than several.
constexpr std::size_t points_per_job = 1U << 13U;

using Range = tbb::blocked_range<std::size_t>;

}  // namespace

void MotionBound::start(const FiberAssembly& fibers) {
  points_ = fibers.points();
  radii_ = fibers.radii();
}

double MotionBound::largest_motion(const FiberAssembly& fibers) const {
  assert(fibers.point_count() == points_.size());
  if (fibers.radii() != radii_) {
    return std::numeric_limits<double>::infinity();
  }
  const double squared = tbb::parallel_reduce(
      Range(0, points_.size(), points_per_job), 0.0,
      [&](const Range& range, double largest) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          largest = std::max(largest, (fibers.points()[i] - points_[i]).squaredNorm());
        }
        return largest;
      },
      [](double a, double b) { return std::max(a, b); });
  // Squares round by less than 4 u; those too small for them are covered by the smallest normal.
  constexpr double slack = 1.0 + 8.0 * std::numeric_limits<double>::epsilon();
  return std::sqrt(squared * slack + std::numeric_limits<double>::min()) * slack;
}

std::size_t MotionBound::memory_bytes() const {
  return points_.capacity() * sizeof(Eigen::Vector3d) + radii_.capacity() * sizeof(double);
}

}  // namespace fiber
