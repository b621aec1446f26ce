#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/options.hpp"
#include "src/cuda/device.hpp"

namespace fiber {

/// @param offsets of fibres, as FiberAssembly has them
HostTopology topology_of(const std::vector<std::uint32_t>& offsets);

/// Adds which fibres are of which candidate.
/// @param candidates as DeviceProximity has them, that require_candidates() has seen
void add_candidates(const std::vector<std::uint32_t>& offsets,
                    const std::vector<std::uint32_t>& candidates, HostTopology& topology);

/// @throws std::invalid_argument for what DeviceProximity may not be given
void require_candidates(const std::vector<std::uint32_t>& candidates, std::size_t fiber_count);

/// @throws std::invalid_argument for more segments than a tree can have
void require_tree_size(std::size_t segment_count);

/// Everything that a device has to know of fibres, but coordinates.
/// @param radii memory for those of segments, if they have more than one [m]; the result refers to
/// it
HostFibers host_fibers(const FiberAssembly& fibers, std::vector<double>& radii);

/// Which pairs of one tree are meant, but for what the host decides.
PairRule pair_rule(double bound, std::uint32_t neighbour_skip, Pairing pairing);

}  // namespace fiber
