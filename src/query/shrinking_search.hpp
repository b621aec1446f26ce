#pragma once

#include <tbb/task_arena.h>

#include <array>
#include <cstdint>
#include <optional>

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/for_engines/pair_collector.hpp"
#include "src/hierarchy/run_tree_kernels.hpp"

namespace fiber {

/// Searches two run trees, or one with itself, on several threads for a collector whose bound
/// shrinks with what it finds: for one contact, the closest ones, those of pairs of fibres.
///
/// Jobs of some groups of segments come in rounds, each as large as all before. The jobs of a round
/// begin with the bound of the rounds before, and the collector absorbs what they find in their
/// order. So the answer, its counts among that, is the same for any number of threads. Keeps its
/// memory from query to query.
class ShrinkingSearch {
 public:
  /// @param moved [m] by how much pairs may be nearer than the trees have them
  /// @param whole of this result; is finished here
  void find(const RunTreeView& a, const RunTreeView& b, double moved, tbb::task_arena& arena,
            PairCollector& whole, QueryResult& result);

 private:
  bool find_together(const RunTreeView& a, const RunTreeView& b, double moved,
                     tbb::task_arena& arena, std::uint32_t begin, std::uint32_t end,
                     PairCollector& whole);

  struct Job {
    QueryResult result;
    std::optional<PairCollector> part;
  };
  // Each finds what it needs anew: more would take more time and memory for that.
  static constexpr std::uint32_t most_jobs = 64;

  std::array<Job, most_jobs> jobs_;  // of a round
};

}  // namespace fiber
