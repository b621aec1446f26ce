#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/sim/forces.hpp"
#include "fiber_proximity/sim/rods.hpp"

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

/// The value at a point of an edge of what is linear along it.
/// @param values of nodes
inline Eigen::Vector3d point_at(const std::vector<Eigen::Vector3d>& values, std::uint32_t edge,
                                double parameter) {
  return (1.0 - parameter) * values[edge] + parameter * values[edge + 1];
}

/// The value at a's point less that at b's; with an obstacle, that at a's point.
/// @param values of nodes: positions, or velocities
inline Eigen::Vector3d difference_of_points(const std::vector<Eigen::Vector3d>& values,
                                            const ContactPoints& points) {
  Eigen::Vector3d found = point_at(values, points.edge_a, points.s);
  if (points.is_of_rods()) {
    found -= point_at(values, points.edge_b, points.t);
  }
  return found;
}

}  // namespace fiber
