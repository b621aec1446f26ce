#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/known_runs.hpp"
#include "src/mpi/local_fibers.hpp"

namespace fiber {

/// Answers the questions of all ranks by the rule of LoopTest: what a rank does not know of the
/// points between two segments it asks their owners. Collective.
/// @param own  segments of this rank
/// @param halo segments of others that it knows
/// @return one per question of this rank
std::vector<bool> find_loops(const Communicator& ranks, const LocalFibers& own,
                             const LocalFibers& halo, const std::vector<LoopQuestion>& questions);

/// Finds loops by the segments of one rank alone.
class LoopsOfRank {
 public:
  explicit LoopsOfRank(const LocalFibers& own) : own_(own), of_others_(none_) {}

  /// Whether there is a loop for certain. If not, there may be one by the points of others.
  bool know_of(const LoopQuestion& question);

 private:
  const LocalFibers none_;
  KnownRuns own_;
  KnownRuns of_others_;
};

}  // namespace fiber
