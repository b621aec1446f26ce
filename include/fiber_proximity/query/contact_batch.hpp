#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/hierarchy/run_blocks.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/pair_test.hpp"

namespace fiber {

/// Finds all contacts of two run trees, or of one with itself, on several threads: candidates job
/// by job, put in the order of the contacts, then judged slice by slice. Every step gives the same
/// for any number of threads. Keeps its memory from query to query.
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
  void sort();
  void judge(const PairTest& test, double bound, std::vector<Contact>& contacts);
  std::size_t judge_round(std::size_t begin, const PairTest& test, double bound,
                          std::vector<Contact>& contacts, std::size_t contact_count);

  std::vector<Job> jobs_;
  std::size_t job_count_ = 0;
  std::vector<std::uint64_t> keys_;  // of pairs, sorted
  std::vector<std::uint64_t> scratch_;
  std::vector<PairDistance> distances_;  // of a round
  std::vector<std::size_t> places_;      // of its slices' contacts
};

}  // namespace fiber
