#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/hierarchy/run_blocks.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/contact_judge.hpp"
#include "fiber_proximity/query/pair_test.hpp"

namespace fiber {

/// Finds all contacts of two run trees, or of one with itself, on several threads: candidates job
/// by job, which a ContactJudge then sorts and judges. Gives the same for any number of threads.
/// Keeps its memory from query to query.
class ContactBatch {
 public:
  /// @param bound [m] pairs of a signed distance of at most this are contacts
  void find(const RunTreeView& a, const RunTreeView& b, const PairTest& test, double bound,
            QueryResult& result);

 private:
  struct Job {
    std::vector<std::uint64_t> keys;
    QueryCounts counts;
  };

  void collect(const RunTreeView& a, const RunTreeView& b, const PairTest& test, float bound,
               QueryCounts& counts);

  std::vector<Job> jobs_;
  ContactJudge judge_;
};

}  // namespace fiber
