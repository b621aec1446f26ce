#pragma once

#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <optional>
#include <variant>
#include <vector>

#include "fiber_proximity/environment/shapes.hpp"
#include "src/environment/convex_solids.hpp"
#include "src/environment/triangle_distance.hpp"
#include "src/sim/contact/contact_points.hpp"
#include "src/sim/contact/edge_contact.hpp"
#include "src/sim/contact/edge_part.hpp"

namespace fiber {

struct MovingShape;

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
  std::uint32_t object;                 ///< index in the environment
  const MovingShape* moving = nullptr;  ///< null where it stands still
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

  const ObstacleShape& shape() const { return *shape_; }

  /// Makes it a piece of the same shape elsewhere.
  /// @param shape must outlive this
  void place_at(const ObstacleShape& shape) { shape_ = &shape; }

  /// Where on a segment it is nearest, in [0, 1].
  double nearest_parameter(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1) const;

  /// The distance of a point in the world. As the piece is convex, so is the distance: it is
  /// nowhere below its tangent planes.
  PointDistance distance_from(const Eigen::Vector3d& point) const;

  /// The point of an edge over the middle of a flat that lies between the ends of the edge: of the
  /// flat that this point is nearest to. None where there is no such flat.
  std::optional<double> middle_of_flat(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1) const;

 private:
  template <class Ask>
  auto ask_solid(const Ask& ask) const;

  const ObstacleShape* shape_;
  Part part_;
};

/// Calls visit(piece) for the pieces of a shape within a distance of a segment [m]. Each of them
/// has a contact of its own: a rod may slide from one to the next.
void visit_near_pieces(const ObstacleShape& shape, const Eigen::Vector3d& p0,
                       const Eigen::Vector3d& p1, double within,
                       const std::function<void(const ObstaclePiece&)>& visit);

/// A node or an edge of a rod and a convex part of an obstacle that it may touch.
///
/// A node has the barrier of its distance. An edge has that of its own times a weight, as edges
/// that cross have (EdgePair): 0 where one of its ends is as near, and 1 where both are too far
/// away to have a barrier of their own. So a rod that lies flat rests on its nodes, and the force
/// on one that slides around a post, touching it with edges, does not jump.
///
/// An edge that lies flat on what is shorter than itself has no end there that it could rest on,
/// and where it turns, its nearest point jumps from one end of the flat to the other: the energy
/// would have a kink. So it has three contacts: of its point over the middle of the flat, with the
/// weight of the edge's, and of the parts on either side of this point.
struct ObstacleContact {
  std::uint32_t rod;
  std::uint32_t edge;  ///< as Rods counts edges
  EdgePart part;
  std::optional<double> point;  ///< of the part, that touches; none for the nearest of an edge
  Barrier barrier;
  double restitution;  ///< of impacts, in [0, 1]
  ObstaclePiece piece;

  /// The values at the ends of its part, of what is linear along the edge.
  /// @param values of nodes
  std::array<Eigen::Vector3d, 2> ends(const std::vector<Eigen::Vector3d>& values) const {
    return {point_at(values, edge, part.first), point_at(values, edge, part.last)};
  }
};

/// The distance of such a contact. Contacts of nodes only have `nearest`.
struct ObstacleDistance {
  PointDistance nearest;              ///< of the point that touches
  double s = 0.0;                     ///< where on the part that is
  std::array<PointDistance, 2> ends;  ///< of the part
  double weight = 1.0;                ///< with 0, `nearest` is only a lower bound of the distance
};

ObstacleDistance obstacle_distance(const ObstacleContact& contact,
                                   const std::vector<Eigen::Vector3d>& positions);

/// @param terms appended to, t being 0; null if only the energy is asked for
/// @returns energy [J], infinite where a distance has reached its least value
double obstacle_contact(const ObstacleContact& contact, const ObstacleDistance& distance,
                        DistanceTerms* terms);

/// Whether tangents prove that the distance of an edge does not fall below a floor while its ends
/// move. A tangent's bound at a place is linear in time: where it is above the floor before and
/// after the motion, it is so all the way. So each place needs one tangent that is above at both
/// times.
/// @param edge from its first end to its last, before the motion
/// @param ways of its ends
bool stays_above(double floor, const ObstacleDistance& distance, const Eigen::Vector3d& edge,
                 const std::array<Eigen::Vector3d, 2>& ways);

/// Shortens a share of a step so that the distance loses no more than a part of its excess over the
/// least one. This is proven: distances from convex pieces are nowhere below their tangent planes.
/// @param displacements of nodes by the whole step [m]
double bounded_share(const ObstacleContact& contact, const ObstacleDistance& distance,
                     const std::vector<Eigen::Vector3d>& positions,
                     const std::vector<Eigen::Vector3d>& displacements, double part, double share);

}  // namespace fiber
