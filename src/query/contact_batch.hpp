#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/for_engines/pair_collector.hpp"
#include "fiber_proximity/query/options.hpp"
#include "src/hierarchy/motion_since_fit.hpp"
#include "src/hierarchy/run_tree_kernels.hpp"
#include "src/query/candidate_cache.hpp"
#include "src/query/contact_evaluator.hpp"
#include "src/query/skin_choice.hpp"

namespace fiber {

/// Finds all contacts of two run trees, or of one with itself, on several threads: candidates job
/// by job, which a ContactEvaluator then decides about. Gives the same for any number of threads.
/// Keeps its memory from query to query.
class ContactBatch {
 public:
  /// Which candidates have been found.
  enum class Found {
    ALL,
    SOME,     ///< those until the deadline
    TOO_MANY  ///< none: there are more than may be examined, and threads share what comes first
  };

  /// Candidates in the order of the contacts: all pairs that may come within the bound [m], and
  /// others; they may serve other queries, too, when points have moved. Takes two thirds of the
  /// time until the deadline, if need be, and less where very many are found: the rest is for
  /// judging.
  /// @param prunes leave out what lacks a loop as the fibres of the test are now
  Found collect(const RunTreeView& a, const RunTreeView& b, const NarrowPhase& test, double bound,
                const QueryLimits& limits, bool prunes, std::vector<std::uint64_t>& keys,
                QueryCounts& counts);

  /// The size of a search of a tree with itself within a bound [m], by a part of it: some groups of
  /// segments, spread over all. Pairs that the whole search would come upon, left-out ones apart;
  /// it ends where they are more than `max_pairs`, or a great many.
  SearchSize estimate(const RunTreeView& tree, const NarrowPhase& test, double bound,
                      double max_pairs, bool prunes);

  /// Reuses candidates of a tree with itself that were collected before: those of dirty
  /// segments are left out and looked for anew.
  Found replace(const std::vector<std::uint64_t>& old_keys, const DirtySegments& dirty,
                const RunTreeView& tree, const NarrowPhase& test, double bound,
                const QueryLimits& limits, std::vector<std::uint64_t>& keys, QueryCounts& counts);

  /// The contacts among such candidates.
  /// @param are_all whether no candidates are missing
  void evaluate(const std::vector<std::uint64_t>& keys, bool are_all, const NarrowPhase& test,
                const QueryLimits& limits, QueryResult& result);

  /// Both, for candidates that serve this query alone.
  /// @param approach of pairs since the trees have had them
  /// @return false, with no answer, if there are more candidates than may be examined
  bool find(const RunTreeView& a, const RunTreeView& b, const NarrowPhase& test,
            const Approach& approach, const QueryLimits& limits, QueryResult& result);

 private:
  struct Job {
    bool complete = true;
    std::vector<std::uint64_t> keys;
    QueryCounts counts;
  };

  std::vector<Job> jobs_;
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint64_t> scratch_;
  ContactEvaluator evaluator_;
};

}  // namespace fiber
