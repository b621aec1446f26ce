#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/known_runs.hpp"
#include "src/mpi/local_fibers.hpp"

namespace fiber {

/// Answers the questions of all ranks by the rule of LoopTest: what a rank does not know of the
/// points between two segments it asks their owners. Collective.
/// @param own  segments of this rank
/// @param halo segments of others that it knows
/// @return one per question of this rank
std::vector<bool> find_loops(const Communicator& ranks, const LocalFibers& own,
                             const LocalFibers& halo, const std::vector<LoopQuestion>& questions);

/// Whether there is a loop for certain, by the segments of one rank alone. If not, there may be one
/// by the points of others.
bool is_known_loop(KnownRuns& own, const LoopQuestion& question);

}  // namespace fiber
