#pragma once

#include <vector>

#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_runs.hpp"
#include "src/mpi/fiber_states.hpp"
#include "src/mpi/piece_boxes.hpp"

namespace fiber {

/// The segments of other ranks that this rank needs for its pairs: those that may come within the
/// margin [m] of one of its own that is before them in the order of contacts, by boxes around a few
/// segments that follow each other. On the way while the rank does other things.
class Halo {
 public:
  /// Finds out what others need, and begins to send it. Collective.
  /// @param own   this rank's; of fibres that move the ways to where they are after that count
  /// @param boxes of own
  Halo(const Communicator& ranks, const FiberStates& own, const PieceBoxes& boxes, double margin);

  /// Waits for what this rank needs. Collective.
  FiberRuns take();

  /// The nodes of the same runs after the motion, none without one. After take(); collective.
  std::vector<FiberNode> take_after() { return joined_nodes(nodes_after_.finish()); }

 private:
  Exchange<FiberRun> runs_;
  Exchange<FiberNode> nodes_;
  Exchange<FiberNode> nodes_after_;
};

}  // namespace fiber
