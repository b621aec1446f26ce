#pragma once

#include "fiber_proximity/sim/contacts.hpp"
#include "src/sim/contact/contact_terms.hpp"

namespace fiber {

/// A contact that begins in a step, its sides approaching each other.
///
/// The incremental potential of the step brings the sides to where they touch, and takes their
/// approach: however short the contact is, and however long the step. What the sides get back is
/// Newton's law of impact: they part with the restitution times the speed of their approach. It is
/// the minimum of a second potential, of the change of velocities u in the step h:
///
///   ½ uᵀ (M + h² K) u + Σ (d/2) max(0, e a − n·(w + J u))²
///
/// with the Hessian K of all else that acts, a dissipative potential of stiffness d in each impact
/// of approach a along the normal n, and the relative velocity w at the end of the first. With the
/// Hessian, a rod that is stiff along its axis bounces off its tip as a whole. Friction in it is
/// Coulomb's, by the normal force of the impact.
///
/// Steps before and after see no impact: none is counted twice, however it is resolved in time
/// (Moreau 1988; Glocker and Studer 2005).
struct Impact {
  /// Sides that approach each other more slowly come to rest [m/s].
  static constexpr double min_speed = 0.05;

  std::size_t contact;  ///< index in its ContactSet
  ContactPoints points;
  Eigen::Vector3d normal;  ///< unit vector from b to a
  double separation;       ///< [m] in a step, at the speed with which they should part; >= 0
  double stiffness = 0.0;  ///< d, by displacements [N/m]

  /// Displacement of a relative to b in a step, at the speeds with which the first minimum ends
  /// [m].
  Eigen::Vector3d motion = Eigen::Vector3d::Zero();

  double pressure = 0.0;                               ///< [N] over the step; >= 0
  Eigen::Vector3d friction = Eigen::Vector3d::Zero();  ///< force on a [N]

  /// Begins the search for the minimum.
  /// @param rods with the velocities with which the first minimum ends
  void begin(const Rods& rods, double step);

  /// The terms of gradient and Hessian of the minimum's equations, which are linear for as long as
  /// no impact's sides part faster than they should, and none begins or ends to slide.
  /// @param law null for no friction
  ContactTerm term(const std::vector<Eigen::Vector3d>& displacements, const Friction* law,
                   double stick_length) const;

  /// Updates the forces to those at the displacements.
  /// @returns the largest change, in parts of the pressure
  double update_forces(const std::vector<Eigen::Vector3d>& displacements, const Friction* law,
                       double stick_length);

 private:
  Eigen::Vector3d motion_after(const std::vector<Eigen::Vector3d>& displacements) const;
};

}  // namespace fiber
