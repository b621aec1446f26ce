#pragma once

#include "fiber_proximity/mpi/distributed_files.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/query/options.hpp"
#include "src/mpi/communicator.hpp"

namespace fiber {

/// What a step takes, an update of fibres that have moved and a query, per segment [s].
struct StepCosts {
  double alone = 0.0;     ///< of a rank that has no others
  double together = 0.0;  ///< of ranks that share fibres, per segment that one has or gets
};

/// Measures the fastest of a few steps, of ranks that bring what they hold: what else travels is
/// not of this machine. All ranks work at once in both: they share it, or would. Collective.
/// @param fibers that this rank brings
StepCosts measure_steps(const Communicator& ranks, const DistributedFibers& fibers,
                        const EngineOptions& engine_options, const QueryOptions& query);

}  // namespace fiber
