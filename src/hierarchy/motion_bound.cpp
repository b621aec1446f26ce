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

/// The largest value(fiber) of all, on all threads.
template <class Value>
double largest_of(const FiberAssembly& fibers, const Value& value) {
  const std::size_t fibers_per_job =
      points_per_job * fibers.fiber_count() / std::max(std::size_t{1}, fibers.point_count());
  return tbb::parallel_reduce(
      Range(0, static_cast<std::uint32_t>(fibers.fiber_count()), fibers_per_job + 1), 0.0,
      [&](const Range& range, double largest) {
        for (std::uint32_t fiber = range.begin(); fiber < range.end(); ++fiber) {
          largest = std::max(largest, value(fiber));
        }
        return largest;
      },
      [](double a, double b) { return std::max(a, b); });
}

/// The largest squared(i) of some points.
template <class Squared>
double largest_of(std::uint32_t begin, std::uint32_t end, const Squared& squared) {
  double largest = 0.0;
  for (std::uint32_t i = begin; i < end; ++i) {
    largest = std::max(largest, squared(i));
  }
  return largest;
}

/// The root of a sum of squares, or more. Squares round by less than 4 u; those too small for them
/// are covered by the smallest normal.
double root_above(double squared) {
  constexpr double slack = 1.0 + 8.0 * std::numeric_limits<double>::epsilon();
  return std::sqrt(squared * slack + std::numeric_limits<double>::min()) * slack;
}

}  // namespace

void MotionBound::reserve(std::size_t points, std::size_t fibers) {
  points_.reserve(points);
  radii_.reserve(fibers);
  by_fiber_.reserve(fibers);
  field_.reserve(points);
}

void MotionBound::start(const FiberAssembly& fibers, const Eigen::Vector3d& lower,
                        const Eigen::Vector3d& upper) {
  points_ = fibers.points();
  radii_ = fibers.radii();
  by_fiber_.assign(fibers.fiber_count(), 0.0);
  longest_segment_.reset();
  // Segments beyond the range of float have boxes without end.
  has_field_ = !points_.empty() && (upper - lower).allFinite();
  if (has_field_) {
    field_.start(points_, lower, upper);
  }
}

void MotionBound::restart(const FiberAssembly& fibers, std::uint32_t fiber) {
  const auto begin = fibers.points().begin();
  std::copy(begin + fibers.offsets()[fiber], begin + fibers.offsets()[fiber + 1],
            points_.begin() + fibers.offsets()[fiber]);
  has_field_ = false;
}

MotionSinceFit MotionBound::measure(const FiberAssembly& fibers, double skin, double margin) {
  assert(fibers.point_count() == points_.size() && fibers.fiber_count() == by_fiber_.size());
  if (fibers.radii() != radii_) {
    return MotionSinceFit::unknown();
  }
  has_by_fiber_ = false;
  beside_others_ = std::numeric_limits<double>::infinity();
  // A sample tells whether it takes more than to see how far each has moved.
  if (has_field_ && 2.0 * field_.sampled_motion(points_, fibers.points()) > skin) {
    if (!longest_segment_) {
      longest_segment_ = longest_segment(fibers);
    }
    const MotionSinceFit beside =
        beside_field(fibers, off_field(fibers, field_.follow(points_, fibers.points())));
    const double nearer = beside.approach.before(margin) - margin;
    beside_others_ = nearer >= 0.0 ? nearer / 2.0 : beside_others_;
    if (beside.leaves(skin, margin)) {
      return beside;
    }
  }
  return measure_alone(fibers);
}

MotionSinceFit MotionBound::measure_alone(const FiberAssembly& fibers) {
  has_by_fiber_ = true;
  return MotionSinceFit::within(largest_of(fibers, [&](std::uint32_t fiber) {
    by_fiber_[fiber] = root_above(largest_of(
        fibers.offsets()[fiber], fibers.offsets()[fiber + 1],
        [&](std::uint32_t i) { return (fibers.points()[i] - points_[i]).squaredNorm(); }));
    return by_fiber_[fiber];
  }));
}

/// [m] Where motion is measured from, rounded up.
double MotionBound::longest_segment(const FiberAssembly& fibers) const {
  return root_above(largest_of(fibers, [&](std::uint32_t fiber) {
    return largest_of(fibers.offsets()[fiber], fibers.offsets()[fiber + 1] - 1,
                      [&](std::uint32_t i) { return (points_[i + 1] - points_[i]).squaredNorm(); });
  }));
}

/// [m] The farthest of a point from where the field has it, at most.
/// @param sampled [m] the same of a sample
double MotionBound::off_field(const FiberAssembly& fibers, double sampled) const {
  // Some points share what the field is at the first of them, where it changes that little.
  constexpr double shared_part = 0.1;
  constexpr double max_shared = 15.0;
  const double change = field_.rate() * *longest_segment_;
  const double others = std::floor(std::min(max_shared, shared_part * sampled / change));
  const auto count = 1 + static_cast<std::uint32_t>(others > 0.0 ? others : 0.0);
  const double off = root_above(largest_of(fibers, [&](std::uint32_t fiber) {
    double squared = 0.0;
    const std::uint32_t end = fibers.offsets()[fiber + 1];
    for (std::uint32_t first = fibers.offsets()[fiber]; first < end; first += count) {
      const Eigen::Vector3d field = field_.at(points_[first]);
      squared =
          std::max(squared, largest_of(first, std::min(end, first + count), [&](std::uint32_t i) {
                     return (fibers.points()[i] - points_[i] - field).squaredNorm();
                   }));
    }
    return squared;
  }));
  return off + (count - 1) * change;
}

/// @param off [m] the field, of each point at most
MotionSinceFit MotionBound::beside_field(const FiberAssembly& fibers, double off) const {
  const double of_points = off + field_.rounding();
  // Between the ends of a segment the field may be off by what it changes along half of it.
  const double way = 2.0 * of_points + field_.rate() * *longest_segment_;
  return {field_.drift(), field_.beyond_drift() + of_points,
          Approach(way, field_.rate(), 2.0 * fibers.largest_radius())};
}

std::size_t MotionBound::memory_bytes() const {
  return points_.capacity() * sizeof(Eigen::Vector3d) +
         (radii_.capacity() + by_fiber_.capacity()) * sizeof(double) + field_.memory_bytes();
}

}  // namespace fiber
