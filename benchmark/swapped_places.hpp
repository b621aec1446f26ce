#pragma once

#include <Eigen/Core>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// The points [m] when every fibre stands where another one stood: the first with the last, the
/// second with the last but one, and so on, each moved as a whole, by its first point. No order in
/// space outlasts that.
std::vector<Eigen::Vector3d> swapped_places(const FiberAssembly& fibers);

}  // namespace fiber
