#include <cmath>
#include <utility>
#include <vector>

#include "src/scenes/large_scenes.hpp"
#include "src/scenes/portable_math.hpp"
#include "src/scenes/scenes.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t fiber_count = 10'000;
constexpr std::uint32_t segments_per_fiber = 100;
constexpr double segment_length = 0.01;  // [m]
constexpr double radius = 3.5e-5;        // [m]
constexpr double bend = 0.15;            // about the angle between neighbouring segments [rad]
constexpr double amplitude = 0.005;      // of the sway [m]
constexpr std::uint64_t typical_segments = 800;
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

void append_walk(std::vector<Vector3d>& points, Random& random, double cube) {
  // The sway must not leave the cube either.
  constexpr double lower = amplitude;
  const double upper = cube - amplitude;
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

/// Adds a fibre.
/// @param cube its edge [m]
/// @param time [periods of the sway]
void append_soup_fiber(std::vector<Vector3d>& points, Random& random, double cube, double time) {
  const std::size_t first = points.size();
  append_walk(points, random, cube);
  const Vector3d sway = amplitude * random.direction();
  const double phase = random.uniform(0.0, 1.0) + time;
  for (std::uint32_t i = 0; i <= segments_per_fiber; ++i) {
    points[first + i] += wave(phase + static_cast<double>(i) / segments_per_fiber) * sway;
  }
}

double soup_time(std::uint32_t frame) {
  return static_cast<double>(frame % soup_period) / soup_period;
}

/// Fibres begin … end - 1 of so many.
FiberAssembly part_of_soup(std::uint64_t count, std::uint64_t seed, std::uint64_t begin,
                           std::uint64_t end, std::uint32_t frame) {
  const double cube = cube_root(static_cast<double>(count) / fiber_count);
  std::vector<Vector3d> points;
  points.reserve((end - begin) * (segments_per_fiber + 1));
  for (std::uint64_t fiber = begin; fiber < end; ++fiber) {
    Random random(stream_seed(seed, fiber));
    append_soup_fiber(points, random, cube, soup_time(frame));
  }
  return equal_fibers(std::move(points), segments_per_fiber + 1, radius);
}

}  // namespace

FiberAssembly soup(const SceneOptions& options, std::uint32_t frame) {
  const std::uint32_t fibers = scaled_fiber_count(options, fiber_count, segments_per_fiber + 1);
  std::vector<Vector3d> points;
  points.reserve(std::size_t{fibers} * (segments_per_fiber + 1));
  Random random(options.seed);
  for (std::uint32_t fiber = 0; fiber < fibers; ++fiber) {
    append_soup_fiber(points, random, 1.0, soup_time(frame));
  }
  return equal_fibers(std::move(points), segments_per_fiber + 1, radius);
}

LargeScene large_soup(std::uint64_t segments, std::uint64_t seed) {
  const std::uint64_t count = (segments + segments_per_fiber - 1) / segments_per_fiber;
  return {count, segments_per_fiber, 3, typical_segments,
          [=](std::uint64_t begin, std::uint64_t end, std::uint32_t frame) {
            return part_of_soup(count, seed, begin, end, frame);
          }};
}

}  // namespace fiber
