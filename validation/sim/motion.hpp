#pragma once

#include "fiber_proximity/sim/stepper.hpp"

namespace fiber {

/// A root k of 1 + cos k cosh k between two numbers: a cantilever of length, bending stiffness and
/// mass 1 swings with k²/2π.
double cantilever_root(double low, double high);

/// Frequency of such a cantilever that is let go in the mode of this root.
double simulated_frequency(int segments, double root);

/// Frequency at which a rod of length, bending and twisting stiffness and mass 1 that is clamped at
/// one end turns its sections back and forth, in its first mode.
/// @param inertia of the sections, per length [kg m]
double simulated_torsion(int segments, double inertia);
double exact_torsion(double inertia);

/// Ratio of a pendulum's period at an amplitude [rad] to that of small ones.
double exact_pendulum_ratio(double amplitude);

/// Periods of small amplitudes: of a mass at the end of a length of 1 m, and of a rod of that
/// length [s].
double point_pendulum_period();
double rod_pendulum_period();

/// The gravity of all pendulums here [m/s²].
extern const Eigen::Vector3d pendulum_gravity;

/// The period with which the last node of rods that are let go swings along x, with BDF2 [s].
double period_of_swing(const Rods& rods, Effects all, double step);

/// The period of a rod of length 1 m that is let go at an angle from the vertical, with BDF2 [s].
/// One segment has its mass at its ends, many have it all along.
/// @param step [s]
double simulated_pendulum_period(int segments, double angle, double step);

/// The same of a rigid part that is all of the rod: a uniform bar, whose small swings take
/// rod_pendulum_period().
double simulated_plug_period(double angle, double step);

/// A rod that falls freely from rest, from a height of 0.
Rods fallen_rod(Integrator integrator, double step, int steps);

/// Where it is then [m]. Implicit Euler is ahead by ½ g t h, BDF2 is exact.
double exact_fall(Integrator integrator, double step, int steps);

}  // namespace fiber
