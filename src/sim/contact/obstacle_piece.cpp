#include "src/sim/contact/obstacle_piece.hpp"

#include <limits>

#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "src/environment/convex_solids.hpp"
#include "src/environment/occupancy_octree.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

using MeshPointer = std::shared_ptr<const TriangleMesh>;
using OctreePointer = std::shared_ptr<const OccupancyOctree>;

PointDistance distance_of(const TriangleCorners& triangle, const Vector3d& point) {
  const Vector3d way = point - nearest_on_triangle(point, triangle).nearest;
  const double distance = way.norm();
  return {distance, distance > 0.0 ? Vector3d(way / distance) : Vector3d::UnitZ()};
}

PointDistance distance_of(const ObstaclePiece::Cell& cell, const Vector3d& point) {
  return point_distance(BoxShape{Vector3d::Constant(cell.size)}, point - cell.center);
}

PointDistance distance_of(const Shape& shape, const Vector3d& point) {
  return std::visit(
      [&](const auto& solid) -> PointDistance {
        using Solid = std::decay_t<decltype(solid)>;
        if constexpr (std::is_same_v<Solid, MeshPointer> || std::is_same_v<Solid, OctreePointer>) {
          assert(false);  // these are in parts
          return {};
        } else {
          return point_distance(solid, point);
        }
      },
      shape);
}

/// All pieces within a distance of a segment, in a shape's frame.
std::vector<ObstaclePiece::Part> parts_near(const Shape& shape, const Vector3d& p0,
                                            const Vector3d& p1, double within) {
  WorldBox box(p0);
  box.extend(p1);
  std::vector<ObstaclePiece::Part> parts;
  if (const auto* const mesh = std::get_if<MeshPointer>(&shape)) {
    (*mesh)->visit_near(box, within,
                        [&](const TriangleCorners& triangle) { parts.emplace_back(triangle); });
  } else if (const auto* const octree = std::get_if<OctreePointer>(&shape)) {
    (*octree)->visit_near(box, within, [&](const Vector3d& center) {
      parts.emplace_back(ObstaclePiece::Cell{center, (*octree)->resolution()});
    });
  } else {
    parts.emplace_back();
  }
  return parts;
}

}  // namespace

bool ObstacleShape::is_convex() const {
  return !std::holds_alternative<MeshPointer>(*shape) &&
         !std::holds_alternative<OctreePointer>(*shape);
}

double ObstaclePiece::nearest_parameter(const Vector3d& p0, const Vector3d& p1) const {
  const Vector3d q0 = shape_->to_shape * p0;
  const Vector3d q1 = shape_->to_shape * p1;
  if (const auto* const triangle = std::get_if<TriangleCorners>(&part_)) {
    return segment_triangle(q0, q1, *triangle).s;
  }
  if (const auto* const cell = std::get_if<Cell>(&part_)) {
    return axis_distance(BoxShape{Vector3d::Constant(cell->size)}, q0 - cell->center,
                         q1 - cell->center)
        .s;
  }
  constexpr double far = std::numeric_limits<double>::infinity();
  return axis_distance(*shape_->shape, q0, q1, far).s;
}

PointDistance ObstaclePiece::distance_from(const Vector3d& point) const {
  const Vector3d local = shape_->to_shape * point;
  PointDistance found;
  if (const auto* const triangle = std::get_if<TriangleCorners>(&part_)) {
    found = distance_of(*triangle, local);
  } else if (const auto* const cell = std::get_if<Cell>(&part_)) {
    found = distance_of(*cell, local);
  } else {
    found = distance_of(*shape_->shape, local);
  }
  found.gradient = shape_->pose.linear() * found.gradient;
  return found;
}

std::vector<ObstaclePiece> near_pieces(const ObstacleShape& shape, const Vector3d& p0,
                                       const Vector3d& p1, double within) {
  const Vector3d q0 = shape.to_shape * p0;
  const Vector3d q1 = shape.to_shape * p1;
  std::vector<ObstaclePiece> pieces;
  for (const ObstaclePiece::Part& part : parts_near(*shape.shape, q0, q1, within)) {
    const ObstaclePiece piece(shape, part);
    const double s = p0 == p1 ? 0.0 : piece.nearest_parameter(p0, p1);
    if (piece.distance_from((1.0 - s) * p0 + s * p1).distance <= within) {
      pieces.push_back(piece);
    }
  }
  return pieces;
}

}  // namespace fiber
