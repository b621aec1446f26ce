#pragma once

#include <vector>

#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_runs.hpp"
#include "src/mpi/fiber_states.hpp"
#include "src/mpi/send_lists.hpp"

namespace fiber {

/// Sends the segments near other ranks to these, and receives the ghosts that this rank needs for
/// its own pairs. They are under way while the rank does other things.
class HaloExchange {
 public:
  /// Begins to send. Collective.
  /// @param own   this rank's
  /// @param spans the send list of each rank: segments of own
  HaloExchange(const Communicator& ranks, const FiberStates& own, const PerRank<RunSpan>& spans);

  /// Waits for the halo of this rank. Collective.
  FiberRuns take();

  /// The nodes of the halo after the motion, none without one. Call it after take(). Collective.
  std::vector<FiberNode> take_after() { return joined(nodes_after_.finish()); }

 private:
  Exchange<FiberRun> runs_;
  Exchange<FiberNode> nodes_;
  Exchange<FiberNode> nodes_after_;
};

}  // namespace fiber
