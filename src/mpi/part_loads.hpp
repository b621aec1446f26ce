#pragma once

#include <cstdint>
#include <vector>

#include "src/mpi/communicator.hpp"
#include "src/mpi/named_fibers.hpp"

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
/// @param own    all fibres, cut into pieces, each on any rank
/// @param parts  as many as there are ranks, or more
/// @param margin [m]
/// @return of each part, in any order; the same on all ranks
/// @throws std::invalid_argument on every rank if Zoltan fails
std::vector<PartLoad> part_loads(const Communicator& ranks, const NamedFibers& own, int parts,
                                 double margin);

}  // namespace fiber
