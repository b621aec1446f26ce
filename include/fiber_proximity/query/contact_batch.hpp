#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/hierarchy/run_blocks.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/contact_judge.hpp"
#include "fiber_proximity/query/outdated_segments.hpp"
#include "fiber_proximity/query/pair_test.hpp"

namespace fiber {

/// Finds all contacts of two run trees, or of one with itself, on several threads: candidates job
/// by job, which a ContactJudge then decides about. Gives the same for any number of threads. Keeps
/// its memory from query to query.
class ContactBatch {
 public:
  /// Candidates in the order of the contacts: all pairs that may come within the bound [m], and
  /// others.
  void collect(const RunTreeView& a, const RunTreeView& b, const PairTest& test, double bound,
               std::vector<std::uint64_t>& keys, QueryCounts& counts);

  /// The same from candidates of a tree with itself that were collected before: those of outdated
  /// segments are left out and looked for anew.
  void replace(const std::vector<std::uint64_t>& old_keys, const OutdatedSegments& outdated,
               const RunTreeView& tree, const PairTest& test, double bound,
               std::vector<std::uint64_t>& keys, QueryCounts& counts);

  /// The contacts among such candidates: pairs of a signed distance of at most the bound [m].
  void judge(const std::vector<std::uint64_t>& keys, const PairTest& test, double bound,
             QueryResult& result);

  /// Both, for candidates that serve this query alone.
  /// @param reach [m] of the candidates: the bound, and what points have moved since the trees were
  /// fitted
  void find(const RunTreeView& a, const RunTreeView& b, const PairTest& test, double reach,
            double bound, QueryResult& result);

 private:
  struct Job {
    std::vector<std::uint64_t> keys;
    QueryCounts counts;
  };

  std::vector<Job> jobs_;
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint64_t> scratch_;
  ContactJudge judge_;
};

}  // namespace fiber
