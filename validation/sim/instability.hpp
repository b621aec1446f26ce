#pragma once

namespace fiber {

/// Rods of 50 segments whose length, bending stiffness, twisting stiffness (unless another is
/// named) and mass are 1, near the loads at which they leave the shape they were in: below, they
/// return from a small disturbance, above, they go ever farther. Growth is how many times farther
/// they are than shortly after they were disturbed.

/// The growth of a column that is clamped at its foot and weighs this much.
double growth_of_column(double weight);
double critical_weight_of_column();

/// The growth of a straight rod between two clamps that are twisted against each other
/// by this angle [rad].
double growth_of_twisted(double angle);
double critical_twist();  ///< Greenhill's

/// The growth of a straight rod between two hinges, when a moment turns its ends against
/// each other [N m]. It creeps, without inertia: a moment that follows the ends it turns has no
/// potential, and what the integrator damps makes motion flutter below the load at which the rod is
/// not stiff any more (Ziegler 1968).
double growth_of_hinged(double moment);
double critical_moment_of_hinged();  ///< Greenhill's

/// The growth of a rod that is bent by nature and hangs from a clamp that points down, beside the
/// plane of its arc.
/// @param curvature [1/m]
double growth_of_curved(double weight, double twisting_stiffness, double curvature);

/// A rod bent to a full circle, with both ends clamped in the same place and twisted against each
/// other. Nothing need disturb it: a clamp hands the moment over in the middle of half an edge, not
/// at its end, and that small difference pushes the ring's halves out of its plane to either side.
struct EndOfRing {
  double height;        ///< in the plane, across from the clamps; 1/π in the beginning
  double out_of_plane;  ///< farthest
};

/// @param angle [rad]
/// @param steps of 0.02 s
EndOfRing end_of_ring(double angle, int steps = 200);
double critical_twist_of_ring();  ///< Michell 1890, Zajac 1962

}  // namespace fiber
