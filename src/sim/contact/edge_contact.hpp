#pragma once

#include <array>
#include <vector>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "src/sim/contact/barrier.hpp"

namespace fiber {

/// Edges of one rod whose indices differ by at most this do not touch but by folding.
constexpr std::uint32_t contact_neighbour_skip = 2;

/// Nor do those with less of the rod between them than this [m], measured at rest: four radii.
inline double contact_neighbour_length(const Rods& rods, std::uint32_t rod) {
  return 4.0 * rods.radii[rod];
}

/// Whether two edges of one rod are too near each other along it to touch.
/// @param arcs arc length at rest from the rod's first node, by node [m]
inline bool are_contact_neighbours(const Rods& rods, const std::vector<double>& arcs,
                                   std::uint32_t rod, std::uint32_t edge_a, std::uint32_t edge_b) {
  const std::uint32_t first = edge_a < edge_b ? edge_a : edge_b;
  const std::uint32_t last = edge_a < edge_b ? edge_b : edge_a;
  return last - first <= contact_neighbour_skip ||
         arcs[last] - arcs[first + 1] < contact_neighbour_length(rods, rod);
}

/// Those arc lengths of all rods.
inline std::vector<double> contact_arcs(const Rods& rods) {
  std::vector<double> arcs(rods.positions.size(), 0.0);
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
      arcs[i + 1] = arcs[i] + rods.rest_lengths[i];
    }
  }
  return arcs;
}

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
