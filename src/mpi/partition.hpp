#pragma once

#include <vector>

#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_runs.hpp"

namespace fiber {

/// A unit of the split, which goes to one rank as a whole.
struct PartitionObject {
  Eigen::Vector3d centre{};  // [m]
  float weight = 1.0F;       // > 0
};

/// Splits the objects of all ranks along a space-filling curve, in parts of about equal weight,
/// which are the same, but for their numbers, however the objects are spread over ranks.
/// Collective.
/// @param parts how many
/// @return for each object of this rank the part it belongs to
/// @throws std::invalid_argument on every rank if Zoltan fails; where it fails on some ranks and
///         others wait for these in it, one ends all by MPI_Abort()
std::vector<int> partition(const Communicator& ranks, const std::vector<PartitionObject>& objects,
                           int parts);

}  // namespace fiber
