#include "src/mpi/gather_fibers.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "src/io/number.hpp"
#include "src/io/radii.hpp"
#include "src/mpi/fiber_chains.hpp"
#include "src/mpi/fiber_runs.hpp"

namespace fiber {
namespace {

/// The parts of a rank as runs; unlike elsewhere, each node has the radius of its point.
FiberRuns runs_of(const DistributedFibers& fibers) {
  FiberRuns runs;
  runs.nodes.reserve(fibers.parts.point_count());
  for (std::size_t part = 0; part < fibers.names.size(); ++part) {
    const std::uint32_t begin = fibers.parts.offsets()[part];
    const std::uint32_t end = fibers.parts.offsets()[part + 1];
    runs.runs.push_back({{fibers.names[part].fiber, fibers.names[part].first_segment},
                         end - begin - 1,
                         runs.nodes.size()});
    for (std::uint32_t p = begin; p < end; ++p) {
      runs.nodes.push_back({fibers.parts.points()[p], fibers.parts.radius_at(part, p)});
    }
  }
  return runs;
}

/// Makes whole fibres of runs that are sorted.
FiberAssembly whole_fibers(const FiberRuns& runs) {
  std::vector<Eigen::Vector3d> points;
  std::vector<double> radii;
  std::vector<std::uint32_t> offsets;
  points.reserve(runs.nodes.size());
  radii.reserve(runs.nodes.size());
  for (const FiberRun& run : runs.runs) {
    const FiberNode* node = runs.nodes.data() + run.begin;
    const FiberNode* const end = node + run.count + 1;
    if (run.first.segment == 0) {
      offsets.push_back(static_cast<std::uint32_t>(points.size()));
    } else {
      if (node->radius != radii.back()) {
        throw std::invalid_argument(
            "fibre " + std::to_string(run.first.fiber) + ": the part from segment " +
            std::to_string(run.first.segment) + " on has the radius " +
            fiber::text_of(node->radius) + " m at its start, the part before has " +
            fiber::text_of(radii.back()) + " m there, which must be the same");
      }
      ++node;
    }
    for (; node != end; ++node) {
      points.push_back(node->point);
      radii.push_back(node->radius);
    }
  }
  if (points.size() > UINT32_MAX) {
    throw std::invalid_argument(std::to_string(points.size()) +
                                " points, one rank can have 4294967295");
  }
  if (points.empty()) {
    return {};
  }
  offsets.push_back(static_cast<std::uint32_t>(points.size()));
  return {std::move(points), std::move(offsets), shared_if_equal(std::move(radii))};
}

/// The names of the fibres of sorted runs, each once.
FiberNames names_of(const FiberRuns& runs, const FiberNames& by_number) {
  std::vector<std::string> names;
  for (const FiberRun& run : runs.runs) {
    if (run.first.segment == 0) {
      names.push_back(by_number.of(run.first.fiber));
    }
  }
  return FiberNames(std::move(names));
}

}  // namespace

WholeFibers gather_fibers(const Communicator& ranks, DistributedFibers fibers) {
  const FiberChains chains(ranks, fibers.parts, fibers.names);
  // Parts that do not meet are refused; of the lengths hardly any are kept.
  chains.arc_lengths(ranks, fibers.parts, fibers.names, 1U << 20U);
  FiberRuns own = runs_of(fibers);
  PerRank<FiberRun> runs(static_cast<std::size_t>(ranks.size()));
  PerRank<FiberNode> nodes(runs.size());
  runs[0] = std::move(own.runs);
  nodes[0] = std::move(own.nodes);
  const FiberNames names = std::move(fibers.fiber_names);
  fibers = {};
  FiberRuns all{joined_runs(ranks.exchange(std::move(runs))),
                joined(ranks.exchange(std::move(nodes)))};
  std::sort(all.runs.begin(), all.runs.end(),
            [](const FiberRun& x, const FiberRun& y) { return x.first < y.first; });
  WholeFibers whole;
  ranks.throw_on_all(error_in([&] { whole = {whole_fibers(all), names_of(all, names)}; }));
  return whole;
}

}  // namespace fiber
