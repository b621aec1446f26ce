#pragma once

#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/mpi/communicator.hpp"

namespace fiber {

/// Whole fibres, and what they are called.
struct WholeFibers {
  FiberAssembly fibers;
  FiberNames names;
};

/// Brings the fibres of all ranks together on rank 0, in the order of their numbers. Collective.
/// @return all of them there, by name or else by number; none on the other ranks
/// @throws std::invalid_argument on every rank where parts do not make whole fibres, and where two
///         that meet have another radius at their common point
WholeFibers gather_fibers(const Communicator& ranks, DistributedFibers fibers);

}  // namespace fiber
