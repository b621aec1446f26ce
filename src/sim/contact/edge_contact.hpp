#pragma once

#include <array>
#include <vector>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "fiber_proximity/sim/rods.hpp"
#include "src/sim/contact/barrier.hpp"

namespace fiber {

/// Two edges that may touch.
struct EdgePair {
  std::uint32_t rod_a;
  std::uint32_t edge_a;  ///< as Rods counts edges
  std::uint32_t rod_b;
  std::uint32_t edge_b;
  Barrier barrier;

  /// For each of the four ends (two of a, two of b): whether the contact of this node and the other
  /// edge is this pair's, not one of a neighbour of the node's edge.
  std::array<bool, 4> owns{};

  /// For each of them: whether the edges before and after the other edge may touch the node, too.
  std::array<std::array<bool, 2>, 4> has_neighbour{};
};

/// A part of a contact's energy that depends on one distance: of a point of an edge a and a point
/// of an edge b.
struct DistanceTerm {
  double s;                ///< curve parameter on a, in [0, 1]
  double t;                ///< curve parameter on b
  Eigen::Vector3d normal;  ///< unit vector from b to a
  double slope;            ///< of the energy by the distance [N]
  double curvature;        ///< a positive part of the second derivative [N/m]

  /// What presses the two together, at least 0 [N]: not all of the slope, part of which takes
  /// weight from one contact of two edges and gives it to another.
  double pressure;

  /// What resists that one end of edge a comes nearer than the other: as that moves the nearest
  /// point along the edge [N/m].
  double turning = 0.0;

  /// What resists a displacement across the normal, where the two attract each other [N/m].
  double across = 0.0;
};

/// The potential of two polylines near each other, edge by edge:
///
/// - Each node has the barrier of its distance from the other polyline: of those from each of its
///   edges, less those from nodes between two of these, which both edges have (Li et al. 2023,
///   Sect. 4). So a node that slides along an other rod feels no step from edge to edge.
/// - Two edges that cross have the barrier of their distance times a weight: 0 where one of their
///   ends is as near to the other edge as they are to each other, as where they lie side by side or
///   meet at a node, and 1 where all ends are too far away to have a barrier of their own. The
///   nearest points of parallel edges jump along them, this energy does not. With less weight the
///   barrier begins nearer, so that ends hold what is pressed before a barrier that is hardly
///   there.
///
/// Gradients are exact, in terms of distances.
/// @param nearest of the two edges, where `positions` has them
/// @param terms   appended to; null if only the energy is asked for
/// @returns energy [J], infinite where a distance is reached below which nothing can get
double edge_contact(const EdgePair& pair, const std::vector<Eigen::Vector3d>& positions,
                    const SegmentDistance& nearest, std::vector<DistanceTerm>* terms);

}  // namespace fiber
