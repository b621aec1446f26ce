#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// Whether so few segments follow each other along the graph from one of these to the other, as
/// their indices would differ by on a chain: 1 for segments that share a point or a joint.
/// @param fibers that have a graph
/// @param max_difference what it is at most; 0 for none
bool are_near_by_count(const FiberAssembly& fibers, PointPair pair, std::uint32_t max_difference);

/// Whether less than this length is between the two along the graph.
/// @param fibers that have a graph
/// @param arc_length [m] by point, from its fibre's start
/// @param length     [m]
bool are_near_by_length(const FiberAssembly& fibers, const std::vector<double>& arc_length,
                        PointPair pair, double length);

}  // namespace fiber
