#include "fiber_proximity/query/contact_batch.hpp"

#include <algorithm>

#include "fiber_proximity/bounds/bounding_volume.hpp"
#include "fiber_proximity/hierarchy/run_tree_kernels.hpp"
#include "fiber_proximity/hierarchy/sort_keys.hpp"
#include "src/query/for_each_of.hpp"

namespace fiber {
namespace {

constexpr std::uint32_t groups_per_job = 32;

// Judging what has been found takes a quarter of the time.
constexpr double part_to_collect = 2.0 / 3.0;

/// Keeps all candidates but those that are no pairs.
class CandidateSink final : public PairSink {
 public:
  /// @param prunes leave out what lacks a loop as the fibres are now
  CandidateSink(const PairTest& test, float bound, bool prunes, std::vector<std::uint64_t>& keys)
      : test_(test), bound_(bound), prunes_(prunes), keys_(keys) {}

  bool offer(PointPair candidate) override {
    const PointPair pair = test_.ordered(candidate);
    if (!test_.is_left_out(pair)) {
      keys_.push_back(key_of(pair));
    }
    return true;
  }

  float bound() const override { return bound_; }
  bool wants_adjacent() const override { return test_.wants_adjacent(); }
  bool rules_out(std::uint32_t first, std::uint32_t last) const override {
    return prunes_ && test_.rules_out(first, last);
  }

 private:
  const PairTest& test_;
  const float bound_;
  const bool prunes_;
  std::vector<std::uint64_t>& keys_;
};

}  // namespace

bool ContactBatch::collect(const RunTreeView& a, const RunTreeView& b, const PairTest& test,
                           double bound, const Deadline& deadline, bool prunes,
                           std::vector<std::uint64_t>& keys, QueryCounts& counts) {
  const float rounded_bound = round_up(bound);
  const std::uint32_t groups = a.group_count();
  const std::uint32_t step = deadline.is_set() ? 1 : groups_per_job;
  const std::size_t job_count =
      b.group_count() == 0 ? 0 : (groups + groups_per_job - 1) / groups_per_job;
  jobs_.resize(std::max(jobs_.size(), job_count));
  for_each_of(job_count, [&](std::size_t index) {
    Job& job = jobs_[index];
    job.keys.clear();
    job.counts = {};
    job.complete = true;
    const auto begin = static_cast<std::uint32_t>(index) * groups_per_job;
    const std::uint32_t end = std::min(groups, begin + groups_per_job);
    CandidateSink sink(test, rounded_bound, prunes, job.keys);
    for (std::uint32_t group = begin; group < end && job.complete; group += step) {
      job.complete = !deadline.has_passed(part_to_collect);
      if (job.complete) {
        find_near_segments(a, group, std::min(end, group + step), b, sink, job.counts);
      }
    }
  });
  keys.clear();
  bool complete = true;
  for (std::size_t job = 0; job < job_count; ++job) {
    keys.insert(keys.end(), jobs_[job].keys.begin(), jobs_[job].keys.end());
    counts += jobs_[job].counts;
    complete = complete && jobs_[job].complete;
  }
  sort_keys(keys, scratch_);
  return complete;
}

bool ContactBatch::replace(const std::vector<std::uint64_t>& old_keys,
                           const OutdatedSegments& outdated, const RunTreeView& tree,
                           const PairTest& test, double bound, const Deadline& deadline,
                           std::vector<std::uint64_t>& keys, QueryCounts& counts) {
  const bool complete = collect(outdated.tree(), tree, test, bound, deadline, keys_, counts);
  // Pairs of two outdated segments are found from both sides.
  keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
  keys.clear();
  auto next = keys_.begin();
  for (const std::uint64_t key : old_keys) {
    const PointPair pair = pair_of(key);
    if (outdated.contains(pair.a) || outdated.contains(pair.b)) {
      continue;
    }
    for (; next != keys_.end() && *next < key; ++next) {
      keys.push_back(*next);
    }
    keys.push_back(key);
  }
  keys.insert(keys.end(), next, keys_.end());
  return complete;
}

void ContactBatch::judge(const std::vector<std::uint64_t>& keys, bool are_all, const PairTest& test,
                         const Deadline& deadline, QueryResult& result) {
  result.counts.primitive_tests += keys.size();
  result.complete = are_all;
  judge_.judge(keys, test, deadline, result);
}

void ContactBatch::find(const RunTreeView& a, const RunTreeView& b, const PairTest& test,
                        double moved, const Deadline& deadline, QueryResult& result) {
  const bool are_all =
      collect(a, b, test, test.margin() + moved, deadline, true, keys_, result.counts);
  judge(keys_, are_all, test, deadline, result);
}

}  // namespace fiber
