#include "fiber_proximity/query/contact_batch.hpp"

#include <algorithm>

#include "fiber_proximity/bounds/bounding_volume.hpp"
#include "fiber_proximity/hierarchy/run_tree_kernels.hpp"
#include "fiber_proximity/hierarchy/sort_keys.hpp"
#include "src/query/for_each_of.hpp"

namespace fiber {
namespace {

constexpr std::uint32_t groups_per_job = 32;

/// Keeps all candidates but those that are no pairs.
class CandidateSink final : public PairSink {
 public:
  CandidateSink(const PairTest& test, float bound, std::vector<std::uint64_t>& keys)
      : test_(test), bound_(bound), keys_(keys) {}

  bool offer(PointPair candidate) override {
    const PointPair pair = test_.ordered(candidate);
    if (!test_.is_neighbour_pair(pair)) {
      keys_.push_back(key_of(pair));
    }
    return true;
  }

  float bound() const override { return bound_; }
  bool wants_adjacent() const override { return test_.wants_adjacent(); }

 private:
  const PairTest& test_;
  const float bound_;
  std::vector<std::uint64_t>& keys_;
};

}  // namespace

void ContactBatch::collect(const RunTreeView& a, const RunTreeView& b, const PairTest& test,
                           double bound, std::vector<std::uint64_t>& keys, QueryCounts& counts) {
  const float rounded_bound = round_up(bound);
  const std::uint32_t groups = a.group_count();
  const std::size_t job_count =
      b.group_count() == 0 ? 0 : (groups + groups_per_job - 1) / groups_per_job;
  jobs_.resize(std::max(jobs_.size(), job_count));
  for_each_of(job_count, [&](std::size_t index) {
    Job& job = jobs_[index];
    job.keys.clear();
    job.counts = {};
    const auto begin = static_cast<std::uint32_t>(index) * groups_per_job;
    CandidateSink sink(test, rounded_bound, job.keys);
    find_near_segments(a, begin, std::min(groups, begin + groups_per_job), b, sink, job.counts);
  });
  keys.clear();
  for (std::size_t job = 0; job < job_count; ++job) {
    keys.insert(keys.end(), jobs_[job].keys.begin(), jobs_[job].keys.end());
    counts.node_tests += jobs_[job].counts.node_tests;
    counts.node_overlaps += jobs_[job].counts.node_overlaps;
  }
  sort_keys(keys, scratch_);
}

void ContactBatch::replace(const std::vector<std::uint64_t>& old_keys,
                           const OutdatedSegments& outdated, const RunTreeView& tree,
                           const PairTest& test, double bound, std::vector<std::uint64_t>& keys,
                           QueryCounts& counts) {
  collect(outdated.tree(), tree, test, bound, keys_, counts);
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
}

void ContactBatch::judge(const std::vector<std::uint64_t>& keys, const PairTest& test, double bound,
                         QueryResult& result) {
  result.counts.primitive_tests += keys.size();
  judge_.judge(keys, test, bound, result.contacts);
}

void ContactBatch::find(const RunTreeView& a, const RunTreeView& b, const PairTest& test,
                        double reach, double bound, QueryResult& result) {
  collect(a, b, test, reach, keys_, result.counts);
  judge(keys_, test, bound, result);
}

}  // namespace fiber
