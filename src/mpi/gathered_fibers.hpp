#pragma once

#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/mpi/communicator.hpp"

namespace fiber {

/// Brings the fibres of all ranks together on rank 0, in the order of their names. Collective.
/// @return all of them there, none on the other ranks
/// @throws std::invalid_argument on every rank where parts do not make whole fibres, and where two
///         that meet have another radius at their common point
FiberAssembly gather_fibers(const Communicator& ranks, DistributedFibers fibers);

}  // namespace fiber
