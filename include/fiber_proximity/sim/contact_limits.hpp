#pragma once

#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

/// Axes of rods do not come nearer than this part of the distance at which surfaces touch, whatever
/// presses them: a spring alone would let them through.
constexpr double least_distance = 0.1;

/// Square of the length of the longest of some vectors, 0 if there are none.
double largest_square(const std::vector<Eigen::Vector3d>& vectors);

/// How far nodes may go in a step before contacts limit it [m]: how fast they will be is not known
/// when it begins, but what to look at within very many edges would be too much.
/// @param fastest how far the fastest node goes at its speed [m]
double longest_move(const Rods& rods, double fastest);

/// How far nodes get from where they were, on the average [m].
/// @param displacements of the nodes from where they are now
Eigen::Vector3d mean_move(const std::vector<Eigen::Vector3d>& from,
                          const std::vector<Eigen::Vector3d>& now,
                          const std::vector<Eigen::Vector3d>& displacements);

/// How far the farthest gets beside a drift: without what all share, pairs of nodes come as near to
/// each other [m].
double farthest_move(const std::vector<Eigen::Vector3d>& from,
                     const std::vector<Eigen::Vector3d>& now,
                     const std::vector<Eigen::Vector3d>& displacements,
                     const Eigen::Vector3d& drift);

/// Shortens a displacement to at most a length.
void limit_length(double most, Eigen::Vector3d& displacement);

/// Shortens a displacement to one that approaches along a unit vector by at most a distance.
/// @returns whether it was longer
bool limit_approach(const Eigen::Vector3d& towards, double most, Eigen::Vector3d& displacement);

}  // namespace fiber
