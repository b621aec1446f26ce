#pragma once

#include <cstdint>
#include <vector>

namespace fiber {

/// A random order of 0 … count − 1, the same on every machine.
std::vector<std::uint32_t> random_order(std::uint32_t count, std::uint64_t seed);

}  // namespace fiber
