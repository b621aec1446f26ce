#pragma once

#include <vector>

#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_runs.hpp"
#include "src/mpi/fiber_states.hpp"
#include "src/mpi/send_lists.hpp"

namespace fiber {

/// The segments of other ranks that this rank needs for its pairs, on the way while the rank does
/// other things.
class HaloExchange {
 public:
  /// Begins to send what others need. Collective.
  /// @param own   this rank's
  /// @param spans of these, by the rank that needs them
  HaloExchange(const Communicator& ranks, const FiberStates& own, const PerRank<RunSpan>& spans);

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
