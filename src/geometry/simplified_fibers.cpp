#include "fiber_proximity/geometry/simplified_fibers.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "fiber_proximity/geometry/chain_runs.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

constexpr double infinity = std::numeric_limits<double>::infinity();

double rounded_up(double value) { return std::nextafter(value, infinity); }

/// [m] How far each segment between begin and end goes along the direction of all, at least.
double least_advance(const std::vector<Vector3d>& points, std::uint32_t begin, std::uint32_t end) {
  // Subnormal vectors get their unit length in two steps.
  const Vector3d axis = (points[end] - points[begin]).stableNormalized().normalized();
  double least = infinity;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Vector3d step = points[i + 1] - points[i];
    least = std::min(least, axis.dot(step) - 0x1p-46 * step.cwiseAbs().sum());
  }
  return least - 0x1p-536;  // for products that underflow
}

}  // namespace

void SimplifiedFibers::update(const FiberAssembly& fibers, double deviation) {
  assert(deviation >= 0.0);
  points_.clear();
  offsets_.assign(1, 0);
  radii_.clear();
  deviations_.clear();
  spreads_.clear();
  advances_.clear();
  origins_.clear();
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const std::uint32_t last = fibers.offsets()[fiber + 1] - 1;
    std::uint32_t point = fibers.offsets()[fiber];
    while (point < last) {
      Run run = longest_run(fibers, point, last, deviation);
      run.advance = least_advance(fibers.points(), point, run.end);
      add(fibers, point, run);
      point = run.end;
    }
    add(fibers, last, Run());
    offsets_.push_back(static_cast<std::uint32_t>(points_.size()));
  }
  assembly_.assign_segments(points_, offsets_, radii_);
}

void SimplifiedFibers::add(const FiberAssembly& fibers, std::uint32_t point, const Run& run) {
  points_.push_back(fibers.points()[point]);
  origins_.push_back(point);
  radii_.push_back(run.radius);
  deviations_.push_back(run.deviation);
  spreads_.push_back(run.spread);
  advances_.push_back(run.advance);
}

SimplifiedFibers::Run SimplifiedFibers::segment(const FiberAssembly& fibers, std::uint32_t begin) {
  return {begin + 1, 0.0, fibers.segment_radius(begin), 0.0, 0.0};
}

/// Whether one piece can replace the run; then sets it.
bool SimplifiedFibers::simplify(const FiberAssembly& fibers, std::uint32_t begin, std::uint32_t end,
                                double deviation, Run& run) {
  double least = fibers.segment_radius(begin);
  double largest = least;
  for (std::uint32_t i = begin + 1; i < end; ++i) {
    least = std::min(least, fibers.segment_radius(i));
    largest = std::max(largest, fibers.segment_radius(i));
  }
  const double limit = deviation - (largest - least);
  const double e = limit > 0.0 ? deviation_of_points(fibers.points(), begin, end, limit) : infinity;
  const double radius = rounded_up(largest + e);
  if (radius > FiberAssembly::max_coordinate) {
    return false;
  }
  // The difference is rounded, then the sum.
  run = {end, e, radius, rounded_up(rounded_up(radius - least) + e), 0.0};
  return true;
}

SimplifiedFibers::Run SimplifiedFibers::longest_run(const FiberAssembly& fibers,
                                                    std::uint32_t begin, std::uint32_t fiber_end,
                                                    double deviation) {
  Run run = segment(fibers, begin);
  long_run(std::min(most_segments, fiber_end - begin), [&](std::uint32_t count) {
    return simplify(fibers, begin, begin + count, deviation, run);
  });
  return run;
}

SimplifiedFibers::Place SimplifiedFibers::place(const FiberAssembly& fibers, std::uint32_t piece,
                                                double s) const {
  const std::uint32_t begin = run_begin(piece);
  const std::uint32_t last = run_end(piece) - 1;
  if (begin == last) {
    return {begin, s};
  }
  const std::vector<Vector3d>& points = fibers.points();
  const Vector3d& a = points[begin];
  const Vector3d u = points[last + 1] - a;
  const double uu = u.squaredNorm();
  double before = 0.0;
  for (std::uint32_t i = begin;; ++i) {
    const double after = projection(points[i + 1], a, u, uu);
    if (after >= s || i == last) {
      // Up to here the projection was below s: it gets there on this segment.
      const double part = after > before ? (s - before) / (after - before) : 0.0;
      return {i, std::clamp(part, 0.0, 1.0)};
    }
    before = after;
  }
}

std::size_t SimplifiedFibers::memory_bytes() const {
  return 2 * points_.capacity() * sizeof(Vector3d) +
         (2 * offsets_.capacity() + origins_.capacity()) * sizeof(std::uint32_t) +
         (3 * radii_.capacity() + deviations_.capacity() + spreads_.capacity() +
          advances_.capacity()) *
             sizeof(double);
}

}  // namespace fiber
