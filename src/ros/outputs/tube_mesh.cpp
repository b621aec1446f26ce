#include "src/ros/outputs/tube_mesh.hpp"

#include <Eigen/Geometry>
#include <cassert>
#include <cmath>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/geometry/smallest_rotation.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;

/// Above this bend (its cosine, 25°) one ring between two segments would visibly pinch the tube.
constexpr double cosine_of_sharp_bend = 0.9;

/// A direction along the tube and one across it, from which the corners are counted.
struct Frame {
  Vector3d tangent;
  Vector3d normal;

  explicit Frame(const Vector3d& direction)
      : tangent(direction), normal(direction.unitOrthogonal()) {}

  /// Turns into the new direction by the smallest rotation that does.
  void turn(const Vector3d& direction) {
    normal = fiber::smallest_rotation(tangent, direction) * normal;
    tangent = direction;
    normal = (normal - normal.dot(tangent) * tangent).normalized();  // rounding does not add up
  }

  TubeRing ring(const Vector3d& center, double radius, std::uint32_t point) const {
    return {center, tangent, normal, tangent.cross(normal), radius, point};
  }
};

/// Unit vectors along the segments of a fibre; a segment of no length has its neighbour's.
std::vector<Vector3d> directions_of(const fiber::FiberAssembly& fibers, std::uint32_t begin,
                                    std::uint32_t end) {
  std::vector<Vector3d> directions;
  directions.reserve(end - begin - 1);
  Vector3d last = Vector3d::Zero();
  for (std::uint32_t point = begin; point + 1 < end; ++point) {
    const Vector3d direction =
        (fibers.points()[point + 1] - fibers.points()[point]).stableNormalized();
    if (!direction.isZero(0.0)) {
      if (last.isZero(0.0)) {
        directions.assign(directions.size(), direction);
      }
      last = direction;
    }
    directions.push_back(last);
  }
  if (last.isZero(0.0)) {
    directions.assign(directions.size(), Vector3d::UnitX());
  }
  return directions;
}

double drawn_radius(const fiber::FiberAssembly& fibers, std::uint32_t point) {
  const double radius = fibers.segment_radius(point);
  return radius > 0.0 ? radius : hairline_radius;
}

}  // namespace

std::vector<Eigen::Vector2d> corner_directions(int sides) {
  assert(sides >= 3);
  std::vector<Eigen::Vector2d> directions;
  directions.reserve(static_cast<std::size_t>(sides));
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * M_PI * i / sides;
    directions.emplace_back(std::cos(angle), std::sin(angle));
  }
  return directions;
}

void sweep_tube(const fiber::FiberAssembly& fibers, std::uint32_t fiber,
                std::vector<TubeRing>& rings) {
  assert(fiber < fibers.fiber_count());
  rings.clear();
  const std::uint32_t begin = fibers.offsets()[fiber];
  const std::uint32_t end = fibers.offsets()[fiber + 1];
  const std::vector<Vector3d> directions = directions_of(fibers, begin, end);

  Frame frame(directions.front());
  double radius = drawn_radius(fibers, begin);
  rings.push_back(frame.ring(fibers.points()[begin], radius, begin));
  for (std::uint32_t point = begin + 1; point + 1 < end; ++point) {
    const Vector3d& center = fibers.points()[point];
    const Vector3d& before = directions[point - begin - 1];
    const Vector3d& after = directions[point - begin];
    const double next_radius = drawn_radius(fibers, point);
    if (before.dot(after) > cosine_of_sharp_bend && next_radius == radius) {
      frame.turn((before + after).normalized());
      rings.push_back(frame.ring(center, radius, point));
    } else {
      frame.turn(before);
      rings.push_back(frame.ring(center, radius, point));
      frame.turn(after);
      rings.push_back(frame.ring(center, next_radius, point));
    }
    radius = next_radius;
  }
  frame.turn(directions.back());
  rings.push_back(frame.ring(fibers.points()[end - 1], radius, end - 1));
}

void append_tube(const fiber::FiberAssembly& fibers, std::uint32_t fiber,
                 std::vector<geometry_msgs::Point>& triangles) {
  static const std::vector<Eigen::Vector2d> directions = corner_directions(tube_sides);
  std::vector<TubeRing> rings;
  sweep_tube(fibers, fiber, rings);
  std::vector<geometry_msgs::Point> corners;
  for_each_corner(rings, directions, Vector3d::Zero(),
                  [&corners](const Vector3d& position, const Vector3d&, const TubeRing&) {
                    corners.push_back(to_message(position));
                  });
  for_each_triangle(static_cast<std::uint32_t>(skin_rows(rings)), tube_sides,
                    [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
                      triangles.insert(triangles.end(), {corners[a], corners[b], corners[c]});
                    });
}

}  // namespace fiber_proximity_ros
