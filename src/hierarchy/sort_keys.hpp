#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/export.hpp"

namespace fiber {

/// Sorts keys in ascending order, on several threads if there are many.
/// @param scratch memory to be kept from call to call; its contents do not matter
FIBER_PROXIMITY_EXPORT void sort_keys(std::vector<std::uint64_t>& keys,
                                      std::vector<std::uint64_t>& scratch);

}  // namespace fiber
