#include "src/hierarchy/motion_bound.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace fiber {
namespace {

// Fibres of this many points together are not shared out: one thread is faster than several.
constexpr std::size_t points_per_job = 1U << 13U;

using Range = tbb::blocked_range<std::uint32_t>;

}  // namespace

void MotionBound::reserve(std::size_t points, std::size_t fibers) {
  points_.reserve(points);
  radii_.reserve(fibers);
  by_fiber_.reserve(fibers);
}

void MotionBound::start(const FiberAssembly& fibers) {
  points_ = fibers.points();
  radii_ = fibers.radii();
  by_fiber_.assign(fibers.fiber_count(), 0.0);
}

void MotionBound::restart(const FiberAssembly& fibers, std::uint32_t fiber) {
  const auto begin = fibers.points().begin();
  std::copy(begin + fibers.offsets()[fiber], begin + fibers.offsets()[fiber + 1],
            points_.begin() + fibers.offsets()[fiber]);
}

double MotionBound::measure(const FiberAssembly& fibers) {
  assert(fibers.point_count() == points_.size() && fibers.fiber_count() == by_fiber_.size());
  if (fibers.radii() != radii_) {
    return std::numeric_limits<double>::infinity();
  }
  const std::size_t fibers_per_job =
      points_per_job * fibers.fiber_count() / std::max(std::size_t{1}, fibers.point_count());
  return tbb::parallel_reduce(
      Range(0, static_cast<std::uint32_t>(fibers.fiber_count()), fibers_per_job + 1), 0.0,
      [&](const Range& range, double largest) {
        for (std::uint32_t fiber = range.begin(); fiber < range.end(); ++fiber) {
          by_fiber_[fiber] = motion_of(fibers, fiber);
          largest = std::max(largest, by_fiber_[fiber]);
        }
        return largest;
      },
      [](double a, double b) { return std::max(a, b); });
}

double MotionBound::motion_of(const FiberAssembly& fibers, std::uint32_t fiber) const {
  double squared = 0.0;
  for (std::size_t i = fibers.offsets()[fiber]; i < fibers.offsets()[fiber + 1]; ++i) {
    squared = std::max(squared, (fibers.points()[i] - points_[i]).squaredNorm());
  }
  // Squares round by less than 4 u; those too small for them are covered by the smallest normal.
  constexpr double slack = 1.0 + 8.0 * std::numeric_limits<double>::epsilon();
  return std::sqrt(squared * slack + std::numeric_limits<double>::min()) * slack;
}

std::size_t MotionBound::memory_bytes() const {
  return points_.capacity() * sizeof(Eigen::Vector3d) +
         (radii_.capacity() + by_fiber_.capacity()) * sizeof(double);
}

}  // namespace fiber
