#include "obstacle_planes.hpp"

#include <algorithm>

#include "fiber_proximity/environment/axis_distance.hpp"
#include "fiber_proximity/environment/occupancy_octree.hpp"
#include "fiber_proximity/environment/triangle_mesh.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

using MeshPointer = std::shared_ptr<const TriangleMesh>;
using OctreePointer = std::shared_ptr<const OccupancyOctree>;

/// Of a triangle.
TangentPlane plane_of(const TriangleCorners& triangle, const Vector3d& p0, const Vector3d& p1) {
  const SegmentTriangle nearest = segment_triangle(p0, p1, triangle);
  const Vector3d way = p0 + nearest.s * (p1 - p0) - nearest.nearest;
  const double distance = way.norm();
  const auto distance_of = [&](const Vector3d& end) {
    return (end - nearest_on_triangle(end, triangle).nearest).norm();
  };
  return {nearest.s,
          distance,
          nearest.nearest,
          distance > 0.0 ? Vector3d(way / distance) : Vector3d::UnitZ(),
          {distance_of(p0), distance_of(p1)}};
}

/// Of a cell.
TangentPlane plane_of(const BoxShape& cell, const Vector3d& p0, const Vector3d& p1) {
  const AxisDistance nearest = axis_distance(cell, p0, p1);
  const Vector3d place = p0 + nearest.s * (p1 - p0);
  return {nearest.s,
          nearest.distance,
          place - nearest.distance * nearest.gradient,
          nearest.gradient,
          {axis_distance(cell, p0, p0).distance, axis_distance(cell, p1, p1).distance}};
}

/// Those in a shape's frame, unfiltered.
std::vector<TangentPlane> all_planes(const Shape& shape, const Vector3d& p0, const Vector3d& p1,
                                     double within) {
  WorldBox box(p0);
  box.extend(p1);
  std::vector<TangentPlane> planes;
  if (const auto* const mesh = std::get_if<MeshPointer>(&shape)) {
    (*mesh)->visit_near(box, within, [&](const TriangleCorners& triangle) {
      planes.push_back(plane_of(triangle, p0, p1));
    });
  } else if (const auto* const octree = std::get_if<OctreePointer>(&shape)) {
    const BoxShape cell{Vector3d::Constant((*octree)->resolution())};
    (*octree)->visit_near(box, within, [&](const Vector3d& center) {
      planes.push_back(plane_of(cell, p0 - center, p1 - center));
      planes.back().point += center;
    });
  }
  return planes;
}

}  // namespace

bool is_convex(const Shape& shape) {
  return !std::holds_alternative<MeshPointer>(shape) &&
         !std::holds_alternative<OctreePointer>(shape);
}

std::vector<TangentPlane> tangent_planes(const Shape& shape, const Eigen::Isometry3d& pose,
                                         const Vector3d& p0, const Vector3d& p1, double within) {
  const Eigen::Isometry3d to_shape = pose.inverse(Eigen::Isometry);
  std::vector<TangentPlane> planes = all_planes(shape, to_shape * p0, to_shape * p1, within);
  std::stable_sort(planes.begin(), planes.end(), [](const TangentPlane& a, const TangentPlane& b) {
    return a.distance < b.distance;
  });
  constexpr double rounding = 1e-6;  // of the distance within
  std::vector<TangentPlane> kept;
  for (const TangentPlane& plane : planes) {
    const bool is_in_front = std::all_of(kept.begin(), kept.end(), [&](const TangentPlane& nearer) {
      return nearer.normal.dot(plane.point - nearer.point) > rounding * within;
    });
    if (plane.distance <= within && is_in_front) {
      kept.push_back(plane);
    }
  }
  for (TangentPlane& plane : kept) {
    plane.point = pose * plane.point;
    plane.normal = pose.linear() * plane.normal;
  }
  return kept;
}

}  // namespace fiber
