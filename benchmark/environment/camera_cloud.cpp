#include "benchmark/environment/camera_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/scenes/portable_math.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double floor_height = -0.75;  // [m]
constexpr double noise = 0.002;         // [1/m] of the depth squared, at most

struct Ball {
  Vector3d centre;
  double radius;  // [m]
};

struct Block {
  Vector3d lower;
  Vector3d upper;
};

/// Depth at which a ray from a point enters a ball, infinity if it misses.
double depth(const Ball& ball, const Vector3d& from, const Vector3d& ray) {
  const Vector3d to_centre = ball.centre - from;
  const double middle = dot(to_centre, ray);
  const double squared = ball.radius * ball.radius - dot(to_centre, to_centre) + middle * middle;
  return squared < 0.0 ? infinity : middle - std::sqrt(squared);
}

double depth(const Block& block, const Vector3d& from, const Vector3d& ray) {
  double enters = 0.0;
  double leaves = infinity;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (block.lower[axis] - from[axis]) / ray[axis];
    const double b = (block.upper[axis] - from[axis]) / ray[axis];
    enters = std::max(enters, std::min(a, b));
    leaves = std::min(leaves, std::max(a, b));
  }
  return enters <= leaves ? enters : infinity;
}

/// The table and what is on it.
struct Clutter {
  explicit Clutter(Random& random) {
    constexpr int count = 10;
    blocks.push_back({{-0.8, -0.6, -0.05}, {0.8, 0.6, 0.0}});
    for (int i = 0; i < count; ++i) {
      Vector3d place = random.point_in_cube(-0.5, 0.5);
      place.z() = 0.0;
      const Vector3d half = random.point_in_cube(0.03, 0.12);
      const Vector3d up(0.0, 0.0, half.z());
      balls.push_back({place + up, half.z()});
      place = 0.8 * Vector3d(place.y(), -place.x(), 0.0);
      blocks.push_back({place + up - half, place + up + half});
    }
  }

  double nearest(const Vector3d& from, const Vector3d& ray) const {
    double least = (floor_height - from.z()) / ray.z();
    for (const Ball& ball : balls) {
      least = std::min(least, depth(ball, from, ray));
    }
    for (const Block& block : blocks) {
      least = std::min(least, depth(block, from, ray));
    }
    return least;
  }

  std::vector<Ball> balls;
  std::vector<Block> blocks;
};

}  // namespace

std::vector<Vector3d> camera_cloud(std::uint32_t count, std::uint64_t seed) {
  Random random(seed);
  const Clutter clutter(random);
  const Vector3d camera(-1.2, 0.0, 1.2);
  const Vector3d forward = unit({1.0, 0.0, -1.0});
  const Vector3d right(0.0, -1.0, 0.0);
  const Vector3d down = forward.cross(right);
  const auto width = static_cast<std::uint32_t>(std::ceil(std::sqrt(count * 4.0 / 3.0)));
  const double pixel = 1.1 / width;  // of a picture 1 m away
  std::vector<Vector3d> points;
  points.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const double column = i % width - 0.5 * width;
    const std::uint32_t whole_rows = i / width;
    const double row = whole_rows - 0.375 * width;
    const Vector3d ray = unit(forward + pixel * column * right + pixel * row * down);
    const double clean = clutter.nearest(camera, ray);
    points.push_back(camera + (clean + noise * clean * clean * random.uniform(-1.0, 1.0)) * ray);
  }
  return points;
}

}  // namespace fiber
