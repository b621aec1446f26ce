#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "src/mpi/communicator.hpp"

namespace fiber {

/// The margin within which the so many closest contacts of all ranks are, as found and in truth
/// [m]; infinity if there are fewer. Collective.
/// @param contacts of this rank, in any order
double margin_of_closest(const Communicator& ranks, std::uint64_t count,
                         const std::vector<DistributedContact>& contacts);

/// Leaves of the contacts of all ranks the so many closest ones. Those that go count in
/// others_lower, of this rank. Collective.
/// @return whether any go, of any rank
bool keep_closest(const Communicator& ranks, std::uint64_t count, DistributedResult& result);

/// Leaves of the contacts that all ranks have found during a motion those that the options ask for,
/// sorted, and sets the flags and bounds of the answer. Collective.
/// @param result all pairs that this rank reports; limit_reached: the pair_limit was
void keep_earliest(const Communicator& ranks, const MotionOptions& options,
                   DistributedMotionResult& result);

}  // namespace fiber
