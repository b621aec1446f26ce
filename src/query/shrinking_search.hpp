#pragma once

#include <tbb/task_arena.h>

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/for_engines/pair_collector.hpp"
#include "src/hierarchy/motion_since_fit.hpp"
#include "src/hierarchy/run_tree_kernels.hpp"
#include "src/query/search_jobs.hpp"

namespace fiber {

/// Searches two run trees, or one with itself, on several threads for a collector whose bound
/// shrinks with what it finds: for one contact, the closest ones, those of pairs of fibres. Keeps
/// its memory from query to query.
class ShrinkingSearch {
 public:
  /// @param approach of pairs since the trees have had them
  /// @param whole of this result; is finished here
  void find(const RunTreeView& a, const RunTreeView& b, const Approach& approach,
            tbb::task_arena& arena, PairCollector& whole, QueryResult& result);

 private:
  SearchJobs<PairCollector> jobs_;  // of some groups of segments
};

}  // namespace fiber
