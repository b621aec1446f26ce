#include "src/ros/outputs/tube_mesh.hpp"

#include <array>
#include <cmath>

#include "fiber_proximity/ros/conversions.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, tube_sides>;

Corners corners_of(const TubeRing& ring) {
  static const std::vector<Eigen::Vector2d> directions = corner_directions(tube_sides);
  Corners corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] = ring.center + ring.radius * ring.outward(directions[i]);
  }
  return corners;
}

/// Spans a closed skin over rings.
class Skin {
 public:
  explicit Skin(std::vector<geometry_msgs::Point>& triangles) : triangles_(triangles) {}

  /// Half a sphere behind the first ring.
  void open(const TubeRing& first) {
    last_ = corners_of(collar(first, -1.0));
    const Vector3d pole = first.center - first.radius * first.tangent;
    for (std::size_t i = 0; i < last_.size(); ++i) {
      add_triangle(pole, last_[next(i)], last_[i]);
    }
  }

  void add(const TubeRing& ring) {
    const Corners corners = corners_of(ring);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      add_triangle(last_[i], last_[next(i)], corners[i]);
      add_triangle(corners[i], last_[next(i)], corners[next(i)]);
    }
    last_ = corners;
  }

  /// Half a sphere ahead of the last ring.
  void close(const TubeRing& last) {
    add(collar(last, 1.0));
    const Vector3d pole = last.center + last.radius * last.tangent;
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
  Corners last_;
};

}  // namespace

void append_tube(const fiber::FiberAssembly& fibers, std::uint32_t fiber,
                 std::vector<geometry_msgs::Point>& triangles) {
  std::vector<TubeRing> rings;
  sweep_tube(fibers, fiber, rings);
  Skin skin(triangles);
  skin.open(rings.front());
  for (const TubeRing& ring : rings) {
    skin.add(ring);
  }
  skin.close(rings.back());
}

}  // namespace fiber_proximity_ros
