#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "src/mpi/fiber_states.hpp"

namespace fiber {

/// A capsule around consecutive segments during their whole motion: around the line from the first
/// point to the last one. It is much tighter than a box where a line runs askew.
struct PieceCapsule {
  Eigen::Vector3d start{};
  Eigen::Vector3d line{};  // [m] from there to the end
  double radius = 0.0;     // [m]
};

/// A ball around one segment during its whole motion.
struct SegmentBall {
  Eigen::Vector3d centre;  // [m]
  double radius = 0.0;     // [m]
};

/// [m²] From a point to a line, both seen from the line's start.
/// @param inverse_square 1 over the square of the line's length, 0 for a line that is a point
inline double square_to_line(const Eigen::Vector3d& point, const Eigen::Vector3d& line,
                             double inverse_square) {
  const double along = std::clamp(point.dot(line) * inverse_square, 0.0, 1.0);
  return (point - along * line).squaredNorm();
}

// Squares of less than this may be lost.
constexpr double lost_length = 0x1p-500;

inline double inverse_square_of(const Eigen::Vector3d& line) {
  const double square = line.squaredNorm();
  return square > lost_length * lost_length ? 1.0 / square : 0.0;
}

/// @param begin, end the first point and the last one
inline PieceCapsule capsule_around(const FiberStates& states, std::uint64_t begin,
                                   std::uint64_t end) {
  const Eigen::Vector3d start = states.before.fibers().points()[begin];
  const Eigen::Vector3d line = states.before.fibers().points()[end] - start;
  const double inverse_square = inverse_square_of(line);
  double square = 0.0;
  double radius = 0.0;
  states.for_each([&](const FiberAssembly& fibers) {
    const Eigen::Vector3d* const points = fibers.points().data();
    for (std::uint64_t p = begin; p <= end; ++p) {
      square = std::max(square, square_to_line(points[p] - start, line, inverse_square));
    }
    radius = std::max(radius, largest_radius(fibers, begin, end));
  });
  return {start, line, radius + std::sqrt(square) + lost_length};
}

/// @param point the segment's first one
inline SegmentBall ball_around(const FiberStates& states, std::uint64_t point) {
  const Eigen::Vector3d* const before = states.before.fibers().points().data() + point;
  const Eigen::Vector3d centre = 0.5 * before[0] + 0.5 * before[1];
  double square = 0.0;
  double radius = 0.0;
  states.for_each([&](const FiberAssembly& fibers) {
    const Eigen::Vector3d* const points = fibers.points().data() + point;
    square =
        std::max({square, (points[0] - centre).squaredNorm(), (points[1] - centre).squaredNorm()});
    radius = std::max(radius, fibers.segment_radius(static_cast<std::uint32_t>(point)));
  });
  return {centre, radius + std::sqrt(square) + lost_length};
}

/// Whether segments within the two may be as near as the margin [m], or be found so near.
inline bool may_come_within(const SegmentBall& ball, const PieceCapsule& capsule, double margin) {
  const Eigen::Vector3d line = capsule.line;
  const Eigen::Vector3d from_start = ball.centre - capsule.start;
  const double distance = std::sqrt(square_to_line(from_start, line, inverse_square_of(line)));
  const double reach = ball.radius + capsule.radius + margin;
  // Far more than the roundings here and those of the distances of what is within.
  return distance - reach <= 0x1p-40 * (distance + line.cwiseAbs().sum() + reach);
}

}  // namespace fiber
