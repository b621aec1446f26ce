#pragma once

#include <geometry_msgs/Point.h>

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber_proximity_ros {

/// Fibres and shapes of radius 0 are drawn with this one, to be seen at all [m].
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
};

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

/// Rows of corners of a tube's skin: one per ring, and one halfway, at 45°, along each half sphere
/// that closes it.
inline std::size_t skin_rows(const std::vector<TubeRing>& rings) { return rings.size() + 2; }

/// The corners of a tube's skin: a pole, rows along the tube, and the other pole.
/// @param directions see corner_directions()
/// @param origin     [m] that positions count from
/// @param add        called with a corner's position [m], the skin's normal, and the corner's ring;
///                   normals have no particular length
template <class Add>
void for_each_corner(const std::vector<TubeRing>& rings,
                     const std::vector<Eigen::Vector2d>& directions, const Eigen::Vector3d& origin,
                     const Add& add) {
  const auto add_corner = [&](const TubeRing& ring, double ahead, const Eigen::Vector3d& across) {
    const Eigen::Vector3d out = across + ahead * ring.tangent;
    add(Eigen::Vector3d(ring.center - origin + ring.radius * out), out, ring);
  };
  const auto add_row = [&](const TubeRing& ring, double ahead) {
    const double aside = std::sqrt(1.0 - ahead * ahead);
    for (const Eigen::Vector2d& direction : directions) {
      const Eigen::Vector3d across = direction.x() * ring.normal + direction.y() * ring.binormal;
      add_corner(ring, ahead, aside * across);
    }
  };
  const double halfway = std::sqrt(0.5);
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  add_corner(rings.front(), -1.0, none);
  add_row(rings.front(), -halfway);
  for (const TubeRing& ring : rings) {
    add_row(ring, 0.0);
  }
  add_row(rings.back(), halfway);
  add_corner(rings.back(), 1.0, none);
}

/// The triangles of a tube's skin, counter-clockwise from outside.
/// @param rows see skin_rows()
/// @param add  called with the numbers of three corners, counted as for_each_corner() has them
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
