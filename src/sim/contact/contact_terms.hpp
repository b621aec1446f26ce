#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/sim/effect.hpp"
#include "fiber_proximity/sim/forces.hpp"

namespace fiber {

/// Points of two edges, or of an edge and an obstacle.
struct ContactPoints {
  static constexpr std::uint32_t no_edge = RodForces::ContactForce::obstacle;

  std::uint32_t rod_a;
  std::uint32_t edge_a;  ///< as Rods counts edges
  double s;
  std::uint32_t rod_b;   ///< the object's index, for an obstacle
  std::uint32_t edge_b;  ///< no_edge for an obstacle
  double t;

  bool is_of_rods() const { return edge_b != no_edge; }
};

/// The velocity of a's point against b's, or against an obstacle [m/s].
/// @param velocities of nodes [m/s]
inline Eigen::Vector3d relative_velocity(const std::vector<Eigen::Vector3d>& velocities,
                                         const ContactPoints& points) {
  const auto at = [&](std::uint32_t edge, double parameter) -> Eigen::Vector3d {
    return (1.0 - parameter) * velocities[edge] + parameter * velocities[edge + 1];
  };
  Eigen::Vector3d found = at(points.edge_a, points.s);
  if (points.is_of_rods()) {
    found -= at(points.edge_b, points.t);
  }
  return found;
}

/// A term of the contacts' gradient and Hessian, by the difference of two points.
struct ContactTerm {
  ContactPoints points;
  Eigen::Vector3d gradient;
  Eigen::Matrix3d hessian;
  double turning;  ///< times g gᵀ, part of the Hessian by the difference of a's ends [1/(N m)]
};

/// Terms by chunk of contacts. Threads share the chunks.
using ContactTerms = std::vector<std::vector<ContactTerm>>;

/// Adds the gradient to some rods, and the blocks of the Hessian between nodes of one edge.
/// @param systems  by rod
/// @param packs    by rod
/// @param which    pack the rods are of
void add_derivatives(const ContactTerms& terms, const Rods& rods,
                     const std::vector<RodSystem*>& systems,
                     const std::vector<std::uint32_t>& packs, std::uint32_t which);

/// Whether the Hessian has other blocks: those between two rods' edges.
bool has_coupling(const ContactTerms& terms);

/// Adds the product of these other blocks with displacements.
/// @param places        of each node's x in these arrays; y and z are lane_count further each
/// @param displacements of all unknowns
void add_coupling(const ContactTerms& terms, const std::vector<std::size_t>& places,
                  const SimdBatch* displacements, SimdBatch* product);

}  // namespace fiber
