#pragma once

#include <memory>
#include <string>

#include "fiber_proximity/sim/stepper.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber {

/// Of the rods that hit something here [m].
constexpr double impact_radius = 0.005;

/// Contacts with a table, the half space below z = 0.
/// @param velocity of the table, which is an obstacle that moves unless this is 0 [m/s]
std::unique_ptr<Contacts> table_with(double restitution, std::shared_ptr<Friction> friction,
                                     const Eigen::Vector3d& velocity = Eigen::Vector3d::Zero());

/// A level rod that falls on a table, from rest relative to it.
struct Drop {
  std::string material = "silicone_tube";
  Integrator integrator = Integrator::IMPLICIT_EULER;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< of the table, and of the rod at first
  double height = 0.3;                                 ///< [m]
  double restitution = 0.2;
  double step = 1.0 / 960.0;  ///< [s]

  /// How long it falls [s].
  double fall() const;
};

/// How high the rod is at the most after it has hit, above where it touches the table [m]; -1 where
/// it does not hit.
double simulated_rebound(const Drop& drop);

/// Impulses on a rod that flies into a table askew: against its sliding, and what presses it [N s].
struct Deflection {
  double along = 0.0;
  double across = 0.0;
  double approach = 0.0;  ///< momentum towards the table before
  bool has_hit = false;
};
Deflection simulated_deflection(Integrator integrator, double step, double restitution,
                                double friction, const std::string& material = "silicone_tube");

/// A box that flies at a rod across its way, with friction, and takes it along.
struct Push {
  Eigen::Vector3d momentum;  ///< of the rod in the end [N s]
  Eigen::Vector3d impulse;   ///< of the box, by the forces on it that are told, added up [N s]
  /// Of a step that is of first order: what the rod's momentum changed by and the box did not feel,
  /// as a part of the largest change in a step.
  double largest_error = 0.0;
};
Push simulated_push(Integrator integrator);

}  // namespace fiber
