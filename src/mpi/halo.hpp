#pragma once

#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_runs.hpp"

namespace fiber {

/// The segments of other ranks that this rank needs for its pairs: those that may come within the
/// margin [m] of one of its own that is before them in the order of contacts, by boxes around a few
/// segments that follow each other. Collective.
FiberRuns find_halo(const Communicator& ranks, const FiberRuns& own, double margin);

}  // namespace fiber
