#pragma once

#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_runs.hpp"
#include "src/mpi/named_fibers.hpp"
#include "src/mpi/piece_boxes.hpp"

namespace fiber {

/// The segments of other ranks that this rank needs for its pairs: those that may come within the
/// margin [m] of one of its own that is before them in the order of contacts, by boxes around a few
/// segments that follow each other. On the way while the rank does other things.
class Halo {
 public:
  /// Finds out what others need, and begins to send it. Collective.
  /// @param boxes of this rank's own
  Halo(const Communicator& ranks, const NamedFibers& own, const PieceBoxes& boxes, double margin);

  /// Waits for what this rank needs. Collective.
  FiberRuns take();

 private:
  Exchange<FiberRun> runs_;
  Exchange<FiberNode> nodes_;
};

}  // namespace fiber
