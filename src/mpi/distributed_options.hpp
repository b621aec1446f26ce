#pragma once

#include "fiber_proximity/query/motion.hpp"
#include "fiber_proximity/query/options.hpp"
#include "src/mpi/communicator.hpp"

namespace fiber {

/// Sees that all ranks ask the same, and what can be answered. Collective.
/// @throws std::invalid_argument on every rank as DistributedEngine::query()
void require_distributed_options(const Communicator& ranks, const QueryOptions& options);
void require_distributed_options(const Communicator& ranks, const MotionOptions& options);

}  // namespace fiber
