#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// Points of fibres that are enough: in each of these states, every point that is left out is
/// within the error of the chord between the points before and after it that stay (Douglas and
/// Peucker 1973, for several states at once). The fibres of a state are then off by at most the
/// error, and a distance of two of them by at most twice as much.
/// @param states of one topology, at least one
/// @param error  [m], > 0
/// @return indices of points that stay, rising; the ends of each fibre and all points of joints are
///         among them, and three points of a closed fibre
std::vector<std::uint32_t> enough_points(const std::vector<const FiberAssembly*>& states,
                                         double error);

/// The same fibres with some of their points. Where radii differ along a fibre, a point has the
/// largest one up to its neighbours, so that the fibre is enclosed as before.
/// @param points as enough_points() has them
FiberAssembly select_points(const FiberAssembly& fibers, const std::vector<std::uint32_t>& points);

}  // namespace fiber
