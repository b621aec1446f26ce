#pragma once

#include <Eigen/Core>

#include "fiber_proximity/environment/triangle_mesh.hpp"

namespace fiber {

/// The nearest part of a triangle: its inside, edge i from corner i to the next one, or corner i.
struct TriangleFeature {
  enum class Kind { FACE, EDGE, CORNER };
  Kind kind = Kind::FACE;
  int index = 0;
};

/// Where a point is nearest to a triangle.
struct PointTriangle {
  Eigen::Vector3d nearest;  ///< on the triangle [m]
  TriangleFeature feature;
};

/// Nearest point of a triangle, which may be a line or a point.
PointTriangle nearest_on_triangle(const Eigen::Vector3d& point, const TriangleCorners& triangle);

/// Where a segment is nearest to a triangle.
struct SegmentTriangle {
  double s = 0.0;           ///< parameter on the segment
  Eigen::Vector3d nearest;  ///< on the triangle [m]
  double distance = 0.0;    ///< [m]; 0 where the segment passes through
};

/// Nearest points of the segment p0–p1 [m] and a triangle: the best of the segment's ends, of its
/// nearest points to the three edges and of where it passes through.
SegmentTriangle segment_triangle(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                                 const TriangleCorners& triangle);

}  // namespace fiber
