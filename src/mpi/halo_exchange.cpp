#include "src/mpi/halo_exchange.hpp"

#include <utility>

namespace fiber {

HaloExchange::HaloExchange(const Communicator& ranks, const FiberStates& own,
                           const PerRank<RunSpan>& spans)
    : runs_(ranks), nodes_(ranks), nodes_after_(ranks) {
  const std::size_t size = spans.size();
  PerRank<FiberRun> runs(size);
  PerRank<FiberNode> nodes(size);
  PerRank<FiberNode> nodes_after(size);
  for (std::size_t other = 0; other < size; ++other) {
    FiberRuns near;
    FiberRuns near_after;
    for (const RunSpan& span : spans[other]) {
      own.before.add_to(near, own.before.runs()[span.run], span.begin, span.end);
      if (own.after != nullptr) {
        own.after->add_to(near_after, own.after->runs()[span.run], span.begin, span.end);
      }
    }
    runs[other] = std::move(near.runs);
    nodes[other] = std::move(near.nodes);
    nodes_after[other] = std::move(near_after.nodes);
  }
  runs_.start(std::move(runs));
  nodes_.start(std::move(nodes));
  if (own.after != nullptr) {
    nodes_after_.start(std::move(nodes_after));
  }
}

FiberRuns HaloExchange::take() {
  FiberRuns all;
  all.runs = joined_runs(runs_.finish());
  all.nodes = joined(nodes_.finish());
  return all;
}

}  // namespace fiber
