#pragma once

#include <Eigen/Geometry>
#include <variant>
#include <vector>

#include "fiber_proximity/environment/shapes.hpp"
#include "src/environment/convex_solids.hpp"
#include "src/environment/triangle_distance.hpp"

namespace fiber {

/// A shape of an object of the environment, where it is in the world.
struct ObstacleShape {
  ObstacleShape(const Shape& own, const Eigen::Isometry3d& in_world, std::uint32_t its_object = 0)
      : shape(&own),
        pose(in_world),
        to_shape(in_world.inverse(Eigen::Isometry)),
        object(its_object) {}

  /// Whether it is one convex piece; meshes and octrees are many.
  bool is_convex() const;

  const Shape* shape;
  Eigen::Isometry3d pose;
  Eigen::Isometry3d to_shape;
  std::uint32_t object;  ///< index in the environment
};

/// A convex part of a shape: all of it, a triangle of a mesh, or a cell of an octree.
class ObstaclePiece {
 public:
  struct Cell {
    Eigen::Vector3d center;  ///< [m]
    double size;             ///< [m]
  };
  using Part = std::variant<std::monostate, TriangleCorners, Cell>;

  /// @param shape must outlive this
  /// @param part  in the shape's frame
  ObstaclePiece(const ObstacleShape& shape, const Part& part) : shape_(&shape), part_(part) {}

  /// The object that it is a part of.
  std::uint32_t object() const { return shape_->object; }

  /// Where on a segment it is nearest, in [0, 1].
  double nearest_parameter(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1) const;

  /// How far a point is, in the world. As the piece is convex, so is the distance: it never falls
  /// below what its gradient promises.
  PointDistance distance_from(const Eigen::Vector3d& point) const;

 private:
  const ObstacleShape* shape_;
  Part part_;
};

/// The pieces of a shape within a distance of a segment [m]. Each of them counts: where a rod has
/// come round a corner, it is another one that holds it.
std::vector<ObstaclePiece> near_pieces(const ObstacleShape& shape, const Eigen::Vector3d& p0,
                                       const Eigen::Vector3d& p1, double within);

}  // namespace fiber
