#include <cmath>
#include <utility>
#include <vector>

#include "src/scenes/portable_math.hpp"
#include "src/scenes/scenes.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t fiber_count = 10'000;
constexpr std::uint32_t segments_per_fiber = 100;
constexpr double segment_length = 0.01;     // [m]
constexpr double radius = 3.5e-5;           // [m]
constexpr double bend = 0.15;               // about the angle between neighbouring segments [rad]
constexpr double amplitude = 0.005;         // of the sway [m]
constexpr std::uint32_t soup_period = 100;  // of the sway [frames]

/// A wave of period and amplitude 1, smooth like the sine but of two parabolas.
double wave(double x) {
  const double phase = x - std::floor(x);
  const bool rising_half = phase < 0.5;
  const double y = rising_half ? 2.0 * phase : 2.0 * phase - 1.0;
  return (rising_half ? 4.0 : -4.0) * y * (1.0 - y);
}

/// Gently turned from where it points.
Vector3d bent(const Vector3d& direction, Random& random) {
  return unit(direction + bend * random.direction());
}

void append_walk(std::vector<Vector3d>& points, Random& random) {
  // The sway must not leave the cube either.
  constexpr double lower = amplitude;
  constexpr double upper = 1.0 - amplitude;
  Vector3d point = random.point_in_cube(lower, upper);
  Vector3d direction = random.direction();
  points.push_back(point);
  for (std::uint32_t i = 0; i < segments_per_fiber; ++i) {
    direction = bent(direction, random);
    for (int axis = 0; axis < 3; ++axis) {
      const double next = point[axis] + segment_length * direction[axis];
      if (next < lower || next > upper) {
        direction[axis] = -direction[axis];
      }
    }
    point += segment_length * direction;
    points.push_back(point);
  }
}

}  // namespace

FiberAssembly soup(const SceneOptions& options, std::uint32_t frame) {
  const std::uint32_t fibers = scaled_fiber_count(options, fiber_count, segments_per_fiber + 1);
  std::vector<Vector3d> points;
  points.reserve(std::size_t{fibers} * (segments_per_fiber + 1));
  Random random(options.seed);
  const double time = static_cast<double>(frame % soup_period) / soup_period;
  for (std::uint32_t fiber = 0; fiber < fibers; ++fiber) {
    const std::size_t first = points.size();
    append_walk(points, random);
    const Vector3d sway = amplitude * random.direction();
    const double phase = random.uniform(0.0, 1.0) + time;
    for (std::uint32_t i = 0; i <= segments_per_fiber; ++i) {
      points[first + i] += wave(phase + static_cast<double>(i) / segments_per_fiber) * sway;
    }
  }
  return equal_fibers(std::move(points), segments_per_fiber + 1, radius);
}

}  // namespace fiber
