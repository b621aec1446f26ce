#include "src/environment/triangle_distance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "fiber_proximity/geometry/segment_distance.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;
using Kind = TriangleFeature::Kind;

Vector3d normal_of(const TriangleCorners& triangle) {
  return (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
}

/// Whether a point above or below a triangle's plane is above or below the triangle itself; of a
/// triangle without a face none is.
bool is_over(const Vector3d& point, const TriangleCorners& triangle, const Vector3d& normal) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d edge = triangle[(i + 1) % 3] - triangle[i];
    if (!(normal.cross(edge).dot(point - triangle[i]) > 0.0)) {
      return false;
    }
  }
  return true;
}

/// The nearest of the three edges.
PointTriangle nearest_on_edges(const Vector3d& point, const TriangleCorners& triangle) {
  PointTriangle best;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const Vector3d& begin = triangle[static_cast<std::size_t>(i)];
    const Vector3d& end = triangle[static_cast<std::size_t>(i + 1) % 3];
    const SegmentDistance distance = segment_distance(point, point, begin, end);
    if (distance.distance < least) {
      least = distance.distance;
      best.nearest = point + distance.delta;
      best.feature = distance.t <= 0.0   ? TriangleFeature{Kind::CORNER, i}
                     : distance.t >= 1.0 ? TriangleFeature{Kind::CORNER, (i + 1) % 3}
                                         : TriangleFeature{Kind::EDGE, i};
    }
  }
  return best;
}

void keep_nearer(double s, const Vector3d& nearest, double distance, SegmentTriangle& best) {
  if (distance < best.distance) {
    best = {s, nearest, distance};
  }
}

}  // namespace

PointTriangle nearest_on_triangle(const Vector3d& point, const TriangleCorners& triangle) {
  const Vector3d normal = normal_of(triangle);
  if (!is_over(point, triangle, normal)) {
    return nearest_on_edges(point, triangle);
  }
  const Vector3d to_plane = normal * (normal.dot(triangle[0] - point) / normal.squaredNorm());
  return {point + to_plane, {Kind::FACE, 0}};
}

SegmentTriangle segment_triangle(const Vector3d& p0, const Vector3d& p1,
                                 const TriangleCorners& triangle) {
  SegmentTriangle best;
  best.distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const SegmentDistance edge = segment_distance(p0, p1, triangle[i], triangle[(i + 1) % 3]);
    keep_nearer(edge.s, p0 + edge.s * (p1 - p0) + edge.delta, edge.distance, best);
  }
  const Vector3d normal = normal_of(triangle);
  const double height0 = normal.dot(p0 - triangle[0]);
  const double height1 = normal.dot(p1 - triangle[0]);
  if ((height0 < 0.0) != (height1 < 0.0)) {
    const double s = height0 / (height0 - height1);
    const Vector3d crossing = p0 + s * (p1 - p0);
    if (is_over(crossing, triangle, normal)) {
      return {s, crossing, 0.0};
    }
  }
  const double length = normal.norm();
  if (is_over(p0, triangle, normal)) {
    keep_nearer(0.0, p0 - normal * (height0 / (length * length)), std::abs(height0) / length, best);
  }
  if (is_over(p1, triangle, normal)) {
    keep_nearer(1.0, p1 - normal * (height1 / (length * length)), std::abs(height1) / length, best);
  }
  return best;
}

}  // namespace fiber
