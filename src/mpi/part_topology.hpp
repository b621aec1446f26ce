#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/geometry/fiber_topology.hpp"
#include "src/mpi/communicator.hpp"

namespace fiber {

/// Whether anything is closed, or has the number of a joint.
inline bool joins_anything(const FiberTopology& topology) {
  const auto is_set = [](std::uint8_t closed) { return closed != 0; };
  const auto is_number = [](std::int32_t joint) { return joint >= 0; };
  return std::any_of(topology.closed.begin(), topology.closed.end(), is_set) ||
         std::any_of(topology.joints.begin(), topology.joints.end(), is_number);
}

/// The joined points among parts of fibres, as DistributedFibers::topology has it: those given
/// beside the parts, or those of the parts themselves. Without vectors if nothing is joined.
/// @throws std::invalid_argument if both are given, and for vectors of other lengths
FiberTopology part_topology(const FiberAssembly& parts, const FiberTopology& given);

/// The joint_tolerance of the ranks that join anything [m]. Collective.
/// @throws std::invalid_argument on every rank if they do not agree
std::optional<double> common_tolerance(const Communicator& ranks, const FiberTopology& topology);

}  // namespace fiber
