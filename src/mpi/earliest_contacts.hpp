#pragma once

#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "src/mpi/communicator.hpp"

namespace fiber {

/// Leaves of what all ranks have found of a motion what the options ask for, sorted, and sets the
/// flags and bounds of the answer. Collective.
/// @param result all pairs that this rank reports; limit_reached: the pair_limit was
void keep_earliest(const Communicator& ranks, const MotionOptions& options,
                   DistributedMotionResult& result);

}  // namespace fiber
