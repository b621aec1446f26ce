#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// Some of the fibres, with their radii, in this order.
/// @param selection indices below the number of fibres
FiberAssembly select_fibers(const FiberAssembly& fibers,
                            const std::vector<std::uint32_t>& selection);

}  // namespace fiber
