#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "src/mpi/communicator.hpp"

namespace fiber {

/// A segment of the fibres of all ranks: fibre and index along it, both as users name them.
struct GlobalSegment {
  std::uint64_t fiber = 0;
  std::uint64_t segment = 0;

  auto key() const { return std::tie(fiber, segment); }
  bool operator<(const GlobalSegment& other) const { return key() < other.key(); }
};

/// A point of a run.
struct FiberNode {
  Eigen::Vector3d point{};  // [m]
  double radius = 0.0;      // [m] of the segment that starts here; 0 at the last point of a run
};

/// Segments of one fibre that follow each other: `count` of them from `first` on, with one node
/// more.
struct FiberRun {
  GlobalSegment first;
  std::uint64_t count = 0;
  std::uint64_t begin = 0;  // its first node among those of its set
  double arc = 0.0;         // [m] along the whole fibre from its start to the run's
};

/// Runs and their nodes, those of a run one after another.
struct FiberRuns {
  std::vector<FiberRun> runs;
  std::vector<FiberNode> nodes;

  std::uint64_t segment_count() const { return nodes.size() - runs.size(); }

  /// Adds a run whose nodes are there. Its last node loses its radius.
  void add(const FiberRun& run, const FiberNode* begin) {
    runs.push_back({run.first, run.count, nodes.size(), run.arc});
    nodes.insert(nodes.end(), begin, begin + run.count + 1);
    nodes.back().radius = 0.0;
  }
};

/// Runs of all ranks as one set; the nodes may follow later.
inline std::vector<FiberRun> joined_runs(const PerRank<FiberRun>& from) {
  std::vector<FiberRun> runs;
  std::uint64_t begin = 0;
  for (const std::vector<FiberRun>& some : from) {
    for (FiberRun run : some) {
      run.begin = begin;
      begin += run.count + 1;
      runs.push_back(run);
    }
  }
  return runs;
}

}  // namespace fiber
