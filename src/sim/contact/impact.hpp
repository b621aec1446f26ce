#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "src/sim/contact/surface_lever.hpp"

namespace fiber {

/// A contact that presses at the end of a step in which contacts begin, their sides approaching
/// each other.
///
/// The incremental potential of the step brings such sides to where they touch, and takes their
/// approach: however short the contact is, and however long the step. What they get back is
/// Newton's law of impact: they part with the restitution times the speed of their approach. The
/// change u of the velocities of nodes, and of the spins of sections where they have some, is a
/// second minimum,
///
///   min ½ uᵀ M u  with  n·(w + J u) >= e a  in each contact,
///
/// with the speed a of approach along the normal n when the step began, the relative velocity w
/// that the first minimum ends with, and Coulomb's friction by the force in that. So every contact
/// has its impact once, however it is resolved in time (Moreau 1988; Glocker 2001). It is one of
/// nodes: what lies behind them comes with the forces in the rod, in the steps after.
///
/// The first minimum leaves the barrier pressed together. What it gives back of that in the steps
/// after is no velocity: as long as a contact of the impact presses, and parts faster than when the
/// step began, its impulse of the step is taken back as far as it has made it so. It never pulls:
/// of all that a contact does in a step, something that pushes is left, or nothing.
struct Impact {
  /// Sides that approach each other more slowly come to rest [m/s].
  static constexpr double min_speed = 0.05;

  /// Only faster returns of a contact are taken back [m/s].
  static constexpr double min_returned_speed = 0.002;

  ContactPoints points;
  Eigen::Vector3d normal;               ///< unit vector from b to a
  std::optional<SurfaceLevers> levers;  ///< from the axes to where its friction acts; none: there

  /// Whether the contact began in this step. One that did not gets nothing back: its sides must
  /// only not approach each other faster.
  bool has_begun = false;

  double separation = 0.0;  ///< speed with which the sides part at least; set if it has begun [m/s]

  /// Impulse that the contact has given its sides in this step and that may be taken back [N s].
  double returnable = 0.0;
  /// The impulse of friction on a that goes with it [N s].
  Eigen::Vector3d step_friction = Eigen::Vector3d::Zero();
  /// Speed down to which that may be [m/s].
  double max_separation = std::numeric_limits<double>::infinity();

  Eigen::Vector3d obstacle_velocity = Eigen::Vector3d::Zero();  ///< of b, if that moves [m/s]

  double pressure = 0.0;  ///< impulse along the normal [N s]; below 0: of what it has given
  Eigen::Vector3d friction = Eigen::Vector3d::Zero();  ///< impulse on a across it [N s]
};

/// Whether a contact returns what an impact has left in it: there is something to take back.
bool is_returning(const Impact& impact, const Rods& rods);

/// Finds the impulses of impacts by projected Gauss-Seidel, and changes velocities and spins by
/// them: contact by contact the impulse with which it parts as it should, never pulling, and the
/// friction that stops it from sliding, within its cone; where some of the normal impulse of the
/// step is taken back, so is what its friction exceeds the cone of the rest by. Equal and opposite
/// impulses at one point keep momentum and angular momentum, however many iterations there are.
/// @param coefficient of friction
void resolve(Rods& rods, double coefficient, std::vector<Impact>& impacts);

}  // namespace fiber
