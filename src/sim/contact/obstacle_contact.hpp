#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "src/sim/contact/edge_contact.hpp"
#include "src/sim/contact/obstacle_piece.hpp"

namespace fiber {

/// A node or an edge of a rod, and a convex part of an obstacle that it may touch.
///
/// A node has the barrier of its distance. An edge has that of its own times a weight, as edges
/// that cross have (EdgePair): 0 where one of its ends is as near, and 1 where both are too far
/// away to have a barrier of their own. So a rod that lies flat rests on its nodes, and one around
/// a post, whose edges touch that anywhere, feels no step as it slides.
struct ObstacleContact {
  enum class Part { FIRST_NODE, LAST_NODE, EDGE };

  std::uint32_t rod;
  std::uint32_t edge;  ///< as Rods counts edges
  Part part;           ///< of the edge
  Barrier barrier;
  ObstaclePiece piece;
};

/// Where that is now. Of a node `nearest` alone is in use.
struct ObstacleDistance {
  PointDistance nearest;
  double s = 0.0;                     ///< where on the edge that is
  std::array<PointDistance, 2> ends;  ///< of an edge
  double weight = 1.0;                ///< with 0, `nearest` is only a lower bound of the distance
};

ObstacleDistance obstacle_distance(const ObstacleContact& contact,
                                   const std::vector<Eigen::Vector3d>& positions);

/// @param terms appended to, t being 0; null if only the energy is asked for
/// @returns energy [J], infinite where a distance is reached below which nothing can get
double obstacle_contact(const ObstacleContact& contact, const ObstacleDistance& distance,
                        std::vector<DistanceTerm>* terms);

/// Shortens a share of a step so that the distance loses no more than a part of what it has beyond
/// the least one. Proven: distances from convex pieces never fall below what their gradients, where
/// rods are now, promise.
/// @param displacements of nodes by the whole step [m]
double bounded_share(const ObstacleContact& contact, const ObstacleDistance& distance,
                     const std::vector<Eigen::Vector3d>& positions,
                     const std::vector<Eigen::Vector3d>& displacements, double part, double share);

}  // namespace fiber
