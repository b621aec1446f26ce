#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/mpi/communicator.hpp"

namespace fiber {

/// What a rank would hold if there were as many ranks as parts.
struct PartLoad {
  std::uint64_t segments = 0;       ///< of its own
  std::uint64_t halo_segments = 0;  ///< of other parts, for pairs within the margin
  std::uint64_t halo_runs = 0;      ///< in which they come
  std::uint64_t neighbours = 0;     ///< parts that it asks for them
};

/// Splits the fibres as DistributedEngine does on so many ranks, and counts what a Halo would
/// bring to each. Collective.
/// @param fibers that this rank brings
/// @param parts  how many
/// @param margin [m]
/// @return of each part, in any order; the same on all ranks
/// @throws std::invalid_argument on every rank as DistributedEngine::update()
std::vector<PartLoad> part_loads(const Communicator& ranks, const DistributedFibers& fibers,
                                 int parts, double margin);

}  // namespace fiber
