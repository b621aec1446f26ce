#pragma once

#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

/// Axes of rods do not come nearer than this part of the distance at which surfaces touch, whatever
/// presses them: a spring alone would let them through.
constexpr double least_distance = 0.1;

/// Speed of the fastest node [m/s].
double fastest_speed(const Rods& rods);

/// How far nodes may go in a step before contacts limit it [m]: how fast they will be is not known
/// when it begins, but what to look at within very many edges would be too much.
/// @param fastest how far the fastest node goes at its speed [m]
double longest_move(const Rods& rods, double fastest);

/// Shortens a displacement to one that approaches along a unit vector by at most a distance.
/// @returns whether it was longer
bool limit_approach(const Eigen::Vector3d& towards, double most, Eigen::Vector3d& displacement);

}  // namespace fiber
