#pragma once

#include <array>
#include <optional>
#include <vector>

#include "src/sim/contact/contact_points.hpp"

namespace fiber {

/// Where friction acts on an edge whose cross-section has a rotation of its own: a point beside the
/// axis. It moves as the axis does, and as its arm does, which turns with the edge and with the
/// section about it. That is linear in the unknowns of the edge: the displacements of its nodes and
/// the turn of its section against its director, which follows the edge.
struct SurfaceLever {
  Eigen::Vector3d arm;      ///< from the axis to the point [m]
  Eigen::Vector3d tangent;  ///< of the edge, a unit vector
  double inverse_length;    ///< of the edge [1/m]

  /// The turn of the director about the edge by the motion of the edge's last node against its
  /// first, as director_turn() has it [rad/m].
  Eigen::Vector3d carried_turn;

  /// The unknowns of an edge, as RodSystem counts them: of its first node, its section, its last
  /// node.
  static constexpr int unknowns = 7;
  using Jacobian = Eigen::Matrix<double, 3, unknowns>;

  /// The motion of the point against that of the axis beside it.
  /// @param edge_change the motion of the edge's last node against its first
  /// @param turn        of the section [rad]; with velocities in place of displacements the spin
  Eigen::Vector3d motion(const Eigen::Vector3d& edge_change, double turn) const {
    const double about_edge = turn + carried_turn.dot(edge_change);
    return (inverse_length * tangent.cross(edge_change) + about_edge * tangent).cross(arm);
  }

  /// The derivative of the point's motion by the unknowns.
  /// @param parameter of the point of the axis on the edge, in [0, 1]
  Jacobian jacobian(double parameter) const;
};

/// Those of a contact's two sides, a and b; with an obstacle only that of a counts.
using SurfaceLevers = std::array<SurfaceLever, 2>;

/// The levers of a contact where the rods are. Those of two rods end in one point, so that equal
/// and opposite forces there leave the angular momentum as it is; with an obstacle the arm is the
/// rod's radius.
/// @param normal unit vector from b to a
/// @returns none without twist: friction acts on the axes
std::optional<SurfaceLevers> surface_levers(const Rods& rods, const ContactPoints& points,
                                            const Eigen::Vector3d& normal);

/// The motion of a's point against b's that goes beyond that of the axes.
/// @param nodes    positions, displacements or velocities of all nodes
/// @param sections angles or spins of all edges
Eigen::Vector3d lever_motion(const SurfaceLevers& levers, const ContactPoints& points,
                             const std::vector<Eigen::Vector3d>& nodes,
                             const std::vector<double>& sections);

}  // namespace fiber
