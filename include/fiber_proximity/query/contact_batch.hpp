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
  /// @param point_count of the first tree's fibres
  void find(const RunTreeView& a, const RunTreeView& b, const PairTest& test, double bound,
            std::size_t point_count, QueryResult& result);

 private:
  struct Job {
    std::vector<PointPair> pairs;
    QueryCounts counts;
  };

  void collect(const RunTreeView& a, const RunTreeView& b, const PairTest& test, float bound,
               QueryCounts& counts);
  void sort_pairs(std::size_t point_count);
  void judge(const PairTest& test, double bound, std::vector<Contact>& contacts);

  std::vector<Job> jobs_;
  std::size_t job_count_ = 0;
  std::vector<PointPair> pairs_;       // sorted
  std::vector<std::uint32_t> begins_;  // by first point of a: where its pairs begin
  std::vector<std::uint8_t> is_contact_;
  std::vector<std::size_t> slice_begins_;  // in the contacts
};

}  // namespace fiber
