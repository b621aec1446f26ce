#pragma once

#include <geometry_msgs/Point.h>

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber_proximity_ros {

/// What stands in for a radius of 0, to be seen at all [m].
constexpr double hairline_radius = 1e-4;

/// A cross-section of a tube. `tangent`, `normal` and `binormal` are an orthonormal, right-handed
/// frame.
struct TubeRing {
  Eigen::Vector3d center;   ///< [m]
  Eigen::Vector3d tangent;  ///< along the tube
  Eigen::Vector3d normal;   ///< where the corners are counted from
  Eigen::Vector3d binormal;
  double radius = 0.0;      ///< [m] above 0
  std::uint32_t point = 0;  ///< of the assembly, in whose place the ring is

  /// Unit vector from the axis to the i-th of `sides` corners.
  /// @param corner cosine and sine of its angle, see corner_directions()
  Eigen::Vector3d outward(const Eigen::Vector2d& corner) const {
    return corner.x() * normal + corner.y() * binormal;
  }
};

/// The ring halfway, at 45°, along the half sphere that closes a tube.
/// @param end the tube's last ring
/// @param side 1 ahead of it, -1 behind it (then it is the tube's first ring)
TubeRing collar(const TubeRing& end, double side);

/// Cosine and sine of the angles of a regular polygon's corners.
/// @param sides at least 3
std::vector<Eigen::Vector2d> corner_directions(int sides);

/// The rings that a fibre's skin is spanned between, from its first point to its last: one at each
/// end and at each gentle bend between segments of one radius, two at any other point, square to
/// the segment before and to the one after.
///
/// The frames turn along the fibre without twist (rotation-minimising). Points that coincide and
/// chains that fold back are fine.
/// @param fiber index below fibers.fiber_count()
/// @param rings overwritten; their memory is reused
void sweep_tube(const fiber::FiberAssembly& fibers, std::uint32_t fiber,
                std::vector<TubeRing>& rings);

/// The triangles of a tube's skin, counter-clockwise from outside. Its corners are numbered: a
/// pole, rows along the tube, each as corner_directions() has them, and the other pole.
/// @param rows one per ring and one on each half sphere
/// @param add  called with the numbers of three corners
template <class Add>
void for_each_triangle(std::uint32_t rows, std::uint32_t sides, const Add& add) {
  const std::uint32_t first_row = 1;
  const std::uint32_t last_row = first_row + (rows - 1) * sides;
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t beside = (i + 1) % sides;
    add(0U, first_row + beside, first_row + i);
    for (std::uint32_t row = first_row; row != last_row; row += sides) {
      add(row + i, row + beside, row + sides + i);
      add(row + sides + i, row + beside, row + sides + beside);
    }
    add(last_row + sides, last_row + i, last_row + beside);
  }
}

/// Number of corners around a tube.
constexpr int tube_sides = 8;

/// Appends a fibre's surface as triangles, three points each [m], for a TRIANGLE_LIST marker.
///
/// Every corner lies at the segment's exact radius from the axis; half spheres close the ends, so
/// the mesh is inscribed in the capsules the queries are about. The corners run along the fibre
/// without twist (rotation-minimising frames). Points that coincide and chains that fold back are
/// fine. A fibre of radius 0 is drawn with `hairline_radius`, to be seen at all.
/// @param fiber index below fibers.fiber_count()
void append_tube(const fiber::FiberAssembly& fibers, std::uint32_t fiber,
                 std::vector<geometry_msgs::Point>& triangles);

}  // namespace fiber_proximity_ros
