#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "fiber_proximity/environment/shapes.hpp"

namespace fiber {

/// Corners [m], counter-clockwise seen from outside.
using TriangleCorners = std::array<Eigen::Vector3d, 3>;

/// Triangles in their own frame, with a tree over them; never changes once it is made, so that any
/// number of threads may ask at once.
///
/// A mesh whose every edge joins two triangles of opposite direction, after vertices at the same
/// place are welded, is closed and encloses a solid: distances inside are negative. Any other is a
/// sheet that can be touched from both sides.
class TriangleMesh {
 public:
  using Triangle = std::array<std::uint32_t, 3>;  ///< indices of vertices, counter-clockwise

  /// More triangles than this are refused: building trees over them takes seconds.
  static constexpr std::size_t max_triangles = 1'000'000;

  /// @param vertices  [m]
  /// @throws std::invalid_argument naming the first index out of range, coordinate that is not
  ///         finite, or too many or no triangles
  TriangleMesh(std::vector<Eigen::Vector3d> vertices, std::vector<Triangle> triangles);
  ~TriangleMesh();
  TriangleMesh(const TriangleMesh&) = delete;
  TriangleMesh& operator=(const TriangleMesh&) = delete;

  const std::vector<Eigen::Vector3d>& vertices() const { return vertices_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const WorldBox& box() const { return box_; }  ///< around the vertices, in their frame [m]
  bool is_closed() const;

  /// Where a segment is nearest to the surface, or deepest inside of it. Infinitely far if nothing
  /// is within the bound [m]. How deep it is inside is known to a sixteenth of that or of the
  /// segment's length, whichever is more; `lower` tells.
  AxisDistance axis_distance(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                             double bound) const;

  /// Calls visit(corners) for the triangles whose boxes are within so much [m] of a box, in an
  /// order that depends on nothing else.
  void visit_near(const WorldBox& box, double within,
                  const std::function<void(const TriangleCorners&)>& visit) const;

 private:
  class Surface;

  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Triangle> triangles_;
  WorldBox box_;
  std::unique_ptr<const Surface> surface_;
};

}  // namespace fiber
