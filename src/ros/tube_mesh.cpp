#include "fiber_proximity/ros/tube_mesh.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cassert>
#include <cmath>

#include "fiber_proximity/ros/conversions.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;
using Ring = std::array<Vector3d, tube_sides>;

constexpr double pi = 3.14159265358979323846;

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
    normal = Eigen::Quaterniond::FromTwoVectors(tangent, direction) * normal;
    tangent = direction;
    normal = (normal - normal.dot(tangent) * tangent).normalized();  // rounding does not add up
  }
};

Ring make_ring(const Vector3d& center, const Frame& frame, double radius) {
  static const auto directions = [] {
    std::array<Eigen::Vector2d, tube_sides> all;
    for (int i = 0; i < tube_sides; ++i) {
      const double angle = 2.0 * pi * i / tube_sides;
      all[static_cast<std::size_t>(i)] = {std::cos(angle), std::sin(angle)};
    }
    return all;
  }();
  const Vector3d binormal = frame.tangent.cross(frame.normal);
  Ring ring;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    ring[i] = center + radius * (directions[i].x() * frame.normal + directions[i].y() * binormal);
  }
  return ring;
}

/// Sweeps rings into a closed skin.
class Skin {
 public:
  explicit Skin(std::vector<geometry_msgs::Point>& triangles) : triangles_(triangles) {}

  /// Half a sphere behind the first ring.
  void open(const Vector3d& center, const Frame& frame, double radius) {
    const double diagonal = radius * std::sqrt(0.5);
    last_ = make_ring(center - diagonal * frame.tangent, frame, diagonal);
    const Vector3d pole = center - radius * frame.tangent;
    for (std::size_t i = 0; i < last_.size(); ++i) {
      add_triangle(pole, last_[next(i)], last_[i]);
    }
  }

  void add(const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      add_triangle(last_[i], last_[next(i)], ring[i]);
      add_triangle(ring[i], last_[next(i)], ring[next(i)]);
    }
    last_ = ring;
  }

  /// Half a sphere ahead of the last ring.
  void close(const Vector3d& center, const Frame& frame, double radius) {
    const double diagonal = radius * std::sqrt(0.5);
    add(make_ring(center + diagonal * frame.tangent, frame, diagonal));
    const Vector3d pole = center + radius * frame.tangent;
    for (std::size_t i = 0; i < last_.size(); ++i) {
      add_triangle(pole, last_[i], last_[next(i)]);
    }
  }

 private:
  static std::size_t next(std::size_t i) { return (i + 1) % tube_sides; }

  void add_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    for (const Vector3d* corner : {&a, &b, &c}) {
      triangles_.push_back(to_message(*corner));
    }
  }

  std::vector<geometry_msgs::Point>& triangles_;
  Ring last_;
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

void append_tube(const fiber::FiberAssembly& fibers, std::uint32_t fiber,
                 std::vector<geometry_msgs::Point>& triangles) {
  assert(fiber < fibers.fiber_count());
  const std::uint32_t begin = fibers.offsets()[fiber];
  const std::uint32_t end = fibers.offsets()[fiber + 1];
  const std::vector<Vector3d> directions = directions_of(fibers, begin, end);

  Frame frame(directions.front());
  double radius = drawn_radius(fibers, begin);
  Skin skin(triangles);
  skin.open(fibers.points()[begin], frame, radius);
  skin.add(make_ring(fibers.points()[begin], frame, radius));
  for (std::uint32_t point = begin + 1; point + 1 < end; ++point) {
    const Vector3d& center = fibers.points()[point];
    const Vector3d& before = directions[point - begin - 1];
    const Vector3d& after = directions[point - begin];
    const double next_radius = drawn_radius(fibers, point);
    if (before.dot(after) > cosine_of_sharp_bend && next_radius == radius) {
      frame.turn((before + after).normalized());
      skin.add(make_ring(center, frame, radius));
    } else {
      frame.turn(before);
      skin.add(make_ring(center, frame, radius));
      frame.turn(after);
      skin.add(make_ring(center, frame, next_radius));
    }
    radius = next_radius;
  }
  frame.turn(directions.back());
  skin.add(make_ring(fibers.points()[end - 1], frame, radius));
  skin.close(fibers.points()[end - 1], frame, radius);
}

}  // namespace fiber_proximity_ros
