#pragma once

#include "fiber_proximity/sim/effects.hpp"
#include "fiber_proximity/sim/stepper.hpp"

namespace fiber {

constexpr int strip_edges = 50;
constexpr double strip_ratio = 4.0;  ///< of its two bending stiffnesses; the small one is 1

RodSection strip(double ratio);

/// A straight rod of 1 m along x.
Rods strip_of(const RodSection& section);

/// Effects of such a rod, clamped at its first node, and its last one loaded.
struct StripScene {
  Rods rods;
  Effects effects;  ///< the hold is the last
};

/// @param side to which it is stiff; 0 for a round rod
StripScene strip_scene(Rods rods, const Eigen::Vector3d& side, const Eigen::Vector3d& force);

/// Where the last node comes to rest.
Eigen::Vector3d settled_tip(StripScene scene);

/// How far the tip goes to its stiff side and across it under a small force to both, by what a
/// round rod of stiffness 1 goes.
struct StripDeflection {
  double stiff;
  double soft;
};
/// @param angle of the stiff side from y [rad]
StripDeflection simulated_strip(double angle);

}  // namespace fiber
