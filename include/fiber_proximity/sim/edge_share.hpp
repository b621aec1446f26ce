#pragma once

#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

/// What part of a contact at a point of an edge is described on this edge, in [0, 1]; what other
/// edges have of it makes that about one. At an end it is all on the edge that comes next, or
/// before, if the target is nearer to that. In the hollow of a bend a target is nearest to inner
/// points of both edges: there one gives way to the other little by little, so that what slides
/// along feels no step.
/// @param target what the point is nearest to [m]
/// @param other  direction of the target's edge, of unit length, if it is inside of that; or zero
double edge_share(const Rods& rods, std::uint32_t rod, std::uint32_t edge, double parameter,
                  const Eigen::Vector3d& target, const Eigen::Vector3d& other);

}  // namespace fiber
