#pragma once

#include <vector>

#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_runs.hpp"

namespace fiber {

/// What goes to one rank as a whole.
struct PartitionObject {
  PlainPoint centre{};  // [m]
  float weight = 1.0F;  // > 0
};

/// Splits the objects of all ranks among them along a space-filling curve, in parts of about equal
/// weight. Collective.
/// @return for each object of this rank the rank it goes to
/// @throws std::invalid_argument on every rank if Zoltan fails
std::vector<int> partition(const Communicator& ranks, const std::vector<PartitionObject>& objects);

}  // namespace fiber
