#pragma once

#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

/// Makes the shape that each rod has now its natural one, in which it is at rest. With twist, that
/// is all of it but a twist between cross-sections, which should be none now; without, the size of
/// the curvature at each node. A clamp finds the rod at rest that continues its outermost edge.
/// @param rods with twist, have their frames already
void set_natural_shape(Rods& rods);

/// Makes an arc the natural shape of a rod with twist. The cross-sections take the side to which it
/// bends with them.
/// @param curvature [1/m]
/// @param towards   to which side of its first edge the rod is to bend; of any length
/// @throws std::invalid_argument for rods without twist, a curvature that is negative or not
///         finite, and a side that is not finite or along the edge
void set_natural_arc(Rods& rods, std::uint32_t rod, double curvature,
                     const Eigen::Vector3d& towards);

}  // namespace fiber
