#pragma once

#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

/// Axes of rods do not come nearer than this part of the distance at which surfaces touch, whatever
/// presses them: a spring alone would let them through.
constexpr double least_distance = 0.1;

/// Edges of one rod that share a node, or are joined by one edge, do not touch but by folding.
constexpr std::uint32_t contact_neighbour_skip = 2;

/// A rod cannot be bent so far that it touches itself within so much of it [m]: four of the largest
/// radius.
double contact_neighbour_length(const Rods& rods);

/// Whether two edges of one rod are too near each other along it to touch. By lengths at rest:
/// where something throws a rod's nodes together, edges far apart along it would be neighbours for
/// as long as they are short, and could change sides.
bool are_contact_neighbours(const Rods& rods, std::uint32_t edge_a, std::uint32_t edge_b);

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
