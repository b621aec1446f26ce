#pragma once

#include <cstddef>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// A default radius that a caller gives for files without radii.
/// @throws std::invalid_argument naming the value and what is allowed
void check_default_radius(double radius);

/// One radius where it serves all points: the cheap form of an assembly.
std::vector<double> shared_if_equal(std::vector<double> radii);

/// Radius at a point: its own if there is one per point, else that of its fibre [m].
double point_radius(const FiberAssembly& fibers, std::size_t fiber, std::size_t point);

}  // namespace fiber
