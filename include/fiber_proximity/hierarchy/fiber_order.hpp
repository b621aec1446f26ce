#pragma once

#include <cstdint>
#include <vector>

namespace fiber {

/// Segments (by the index of their first point) in end-point-connected order (paper, Sect. 3.1):
/// the fibres one after another, every other one backwards, so that the last segment of a fibre is
/// followed by the last segment of the next.
/// @param offsets as in FiberAssembly
std::vector<std::uint32_t> end_point_connected_order(const std::vector<std::uint32_t>& offsets);

}  // namespace fiber
