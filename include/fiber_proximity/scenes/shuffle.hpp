#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// A random order of 0 … count − 1, the same on every machine.
std::vector<std::uint32_t> random_order(std::uint32_t count, std::uint64_t seed);

/// The same fibres in another order.
/// @param order of each new fibre, the index of the old one; a permutation
FiberAssembly reordered(const FiberAssembly& fibers, const std::vector<std::uint32_t>& order);

}  // namespace fiber
