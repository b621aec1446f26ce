#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// Where fibres come to that each go their own way: every point moves equally far, in a direction
/// that turns once along its fibre in a plane of its own. What the fibres are before is kept as
/// well as can be: neighbours along one go nearly the same way, those of others any.
/// @param way [m] of every point
std::vector<Eigen::Vector3d> after_own_ways(const FiberAssembly& before, double way,
                                            std::uint64_t seed);

}  // namespace fiber
