#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "src/mpi/communicator.hpp"

namespace fiber {

struct ArcLengths {
  std::vector<double> of_pieces;  ///< [m] of each part one after another
  double roundings = 0.0;         ///< [m] most that any is rounded by, of all ranks, in units of ε
};

/// How the parts of this rank go on at other parts of their fibres.
class FiberChains {
 public:
  /// Sees that the parts of all ranks make whole fibres. Collective.
  /// @throws std::invalid_argument on every rank naming the fibre and segment where parts overlap
  ///         or one is missing
  FiberChains(const Communicator& ranks, const FiberAssembly& parts,
              const std::vector<FiberPart>& names);

  /// Arc lengths from the start of whole fibres: the same sums, in the same order, as one process
  /// makes. Each part waits for the one before it. Collective.
  /// @param every  so many segments of a part, the length to their first point is kept
  /// @throws std::invalid_argument on every rank if a part does not start where the one before ends
  ArcLengths arc_lengths(const Communicator& ranks, const FiberAssembly& parts,
                         const std::vector<FiberPart>& names, std::uint32_t every) const;

 private:
  /// A part by its place among this rank's, and who has the parts beside it; none: -1.
  struct Link {
    std::uint32_t part = 0;
    int before = -1;
    int after = -1;
  };

  std::vector<Link> links_;  // in the order of fibres and segments
};

}  // namespace fiber
