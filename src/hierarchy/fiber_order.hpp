#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/export.hpp"

namespace fiber {

/// An order of all segments of an assembly, by the indices of their first points.
/// @param offsets as in FiberAssembly
using FiberOrder = std::vector<std::uint32_t> (*)(const std::vector<std::uint32_t>& offsets);

/// Segments in end-point-connected order (paper, Sect. 3.1): the fibres one after another, every
/// other one backwards, so that the last segment of a fibre is followed by the last segment of the
/// next.
FIBER_PROXIMITY_EXPORT std::vector<std::uint32_t> end_point_connected_order(
    const std::vector<std::uint32_t>& offsets);

/// The threading scheme (Sect. 3.1): segments with the same ordinal number side by side, fibre
/// after fibre.
/// @throws std::invalid_argument naming the first fibre whose number of segments differs
FIBER_PROXIMITY_EXPORT std::vector<std::uint32_t> threading_order(
    const std::vector<std::uint32_t>& offsets);

}  // namespace fiber
