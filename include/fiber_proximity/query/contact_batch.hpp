#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/hierarchy/run_blocks.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/contact_judge.hpp"
#include "fiber_proximity/query/deadline.hpp"
#include "fiber_proximity/query/outdated_segments.hpp"
#include "fiber_proximity/query/pair_test.hpp"

namespace fiber {

/// Finds all contacts of two run trees, or of one with itself, on several threads: candidates job
/// by job, which a ContactJudge then decides about. Gives the same for any number of threads. Keeps
/// its memory from query to query.
class ContactBatch {
 public:
  /// Candidates in the order of the contacts: all pairs that may come within the bound [m], and
  /// others; they may serve other queries, too, when points have moved. Takes two thirds of the
  /// time until the deadline, if need be: the rest is for judging.
  /// @return whether they are all
  bool collect(const RunTreeView& a, const RunTreeView& b, const PairTest& test, double bound,
               const Deadline& deadline, std::vector<std::uint64_t>& keys, QueryCounts& counts) {
    return collect(a, b, test, bound, deadline, false, keys, counts);
  }

  /// The same from candidates of a tree with itself that were collected before: those of outdated
  /// segments are left out and looked for anew.
  bool replace(const std::vector<std::uint64_t>& old_keys, const OutdatedSegments& outdated,
               const RunTreeView& tree, const PairTest& test, double bound,
               const Deadline& deadline, std::vector<std::uint64_t>& keys, QueryCounts& counts);

  /// The contacts among such candidates.
  /// @param are_all whether no candidates are missing
  void judge(const std::vector<std::uint64_t>& keys, bool are_all, const PairTest& test,
             const Deadline& deadline, QueryResult& result);

  /// Both, for candidates that serve this query alone.
  /// @param moved [m] by how much pairs may be nearer than the trees have them
  void find(const RunTreeView& a, const RunTreeView& b, const PairTest& test, double moved,
            const Deadline& deadline, QueryResult& result);

 private:
  bool collect(const RunTreeView& a, const RunTreeView& b, const PairTest& test, double bound,
               const Deadline& deadline, bool prunes, std::vector<std::uint64_t>& keys,
               QueryCounts& counts);

  struct Job {
    bool complete = true;
    std::vector<std::uint64_t> keys;
    QueryCounts counts;
  };

  std::vector<Job> jobs_;
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint64_t> scratch_;
  ContactJudge judge_;
};

}  // namespace fiber
