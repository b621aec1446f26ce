#pragma once

#include <functional>

#include "fiber_proximity/query/contact.hpp"
#include "src/hierarchy/run_tree_kernels.hpp"
#include "src/mpi/local_fibers.hpp"

namespace fiber {

/// Offers pairs of a segment of the halo (a) and one of this rank's own (b) that may come within
/// the sink's bound: all of those where the own one comes first by name, and few others. For where
/// nearly all is near: there half of the pairs are another rank's, and would be looked at in vain.
/// @param is_over asked often
void offer_ordered_pairs(const LocalFibers& halo, const LocalFibers& own, PairSink& sink,
                         const std::function<bool()>& is_over, QueryCounts& counts);

}  // namespace fiber
