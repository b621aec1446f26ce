#pragma once

#include <cstdint>
#include <vector>

#include "src/cuda/device.hpp"

namespace fiber {

/// @param offsets of fibres, as FiberAssembly has them
HostTopology topology_of(const std::vector<std::uint32_t>& offsets);

/// @throws std::invalid_argument for more segments than a tree can have
void require_tree_size(std::size_t segment_count);

}  // namespace fiber
