#include "src/query/contact_batch.hpp"

#include <algorithm>
#include <atomic>

#include "src/bounds/bounding_volume.hpp"
#include "src/hierarchy/run_tree_kernels.hpp"
#include "src/hierarchy/sort_keys.hpp"
#include "src/query/threads.hpp"

namespace fiber {
namespace {

constexpr std::uint32_t groups_per_job = 32;

// Judging what has been found takes a quarter of the time.
constexpr double part_to_collect = 2.0 / 3.0;

/// The candidates that all threads come by.
struct CandidateCount {
  const std::uint64_t most;
  std::atomic<std::uint64_t> count{0};

  /// Once and for all: whether it comes to that does not depend on the threads.
  bool is_too_much() const { return count.load(std::memory_order_relaxed) > most; }
};

/// Keeps all candidates but those that are no pairs.
class CandidateSink final : public PairSink {
 public:
  /// @param prunes leave out what lacks a loop as the fibres are now
  CandidateSink(const NarrowPhase& test, float bound, bool prunes, CandidateCount& count,
                std::vector<std::uint64_t>& keys)
      : test_(test), bound_(bound), prunes_(prunes), count_(count), keys_(keys) {}
  CandidateSink(const CandidateSink&) = delete;
  CandidateSink& operator=(const CandidateSink&) = delete;
  ~CandidateSink() override { count_.count.fetch_add(uncounted_, std::memory_order_relaxed); }

  bool offer(PointPair candidate) override {
    const PointPair pair = test_.ordered(candidate);
    if (!test_.is_left_out(pair)) {
      keys_.push_back(key_of(pair));
    }
    return ++uncounted_ < uncounted_at_most || count_and_go_on();
  }

  float bound() const override { return bound_; }
  bool bound_shrinks() const override { return false; }

  bool wants_adjacent() const override { return test_.wants_adjacent(); }
  PointRange ruled_out_with(std::uint32_t point) const override {
    return prunes_ ? test_.ruled_out_with(point) : PointRange{};
  }

 private:
  static constexpr std::uint32_t uncounted_at_most = 1024;  // threads wait for each other to count

  bool count_and_go_on() {
    count_.count.fetch_add(uncounted_, std::memory_order_relaxed);
    uncounted_ = 0;
    return !count_.is_too_much();
  }

  const NarrowPhase& test_;
  const float bound_;
  const bool prunes_;
  CandidateCount& count_;
  std::uint32_t uncounted_ = 0;
  std::vector<std::uint64_t>& keys_;
};

}  // namespace

ContactBatch::Found ContactBatch::collect(const RunTreeView& a, const RunTreeView& b,
                                          const NarrowPhase& test, double bound,
                                          const QueryLimits& limits, bool prunes,
                                          std::vector<std::uint64_t>& keys, QueryCounts& counts) {
  const float rounded_bound = round_up(bound);
  const std::uint32_t groups = a.group_count();
  const std::uint32_t step = limits.deadline.is_set() ? 1 : groups_per_job;
  const std::size_t job_count =
      b.group_count() == 0 ? 0 : (groups + groups_per_job - 1) / groups_per_job;
  jobs_.resize(std::max(jobs_.size(), job_count));
  CandidateCount count{limits.pairs};
  for_each_of(job_count, [&](std::size_t index) {
    Job& job = jobs_[index];
    job.keys.clear();
    job.counts = {};
    job.complete = true;
    const auto begin = static_cast<std::uint32_t>(index) * groups_per_job;
    const std::uint32_t end = std::min(groups, begin + groups_per_job);
    CandidateSink sink(test, rounded_bound, prunes, count, job.keys);
    for (std::uint32_t group = begin; group < end && job.complete && !count.is_too_much();
         group += step) {
      job.complete = !limits.deadline.has_passed(part_to_collect);
      if (job.complete) {
        find_near_segments(a, group, std::min(end, group + step), b, sink, job.counts.node_tests,
                           job.counts.node_overlaps);
      }
    }
  });
  keys.clear();
  if (count.is_too_much()) {
    jobs_.clear();  // so much memory is not kept
    return Found::TOO_MANY;
  }
  bool complete = true;
  for (std::size_t job = 0; job < job_count; ++job) {
    keys.insert(keys.end(), jobs_[job].keys.begin(), jobs_[job].keys.end());
    counts += jobs_[job].counts;
    complete = complete && jobs_[job].complete;
  }
  sort_keys(keys, scratch_);
  return complete ? Found::ALL : Found::SOME;
}

ContactBatch::Found ContactBatch::replace(const std::vector<std::uint64_t>& old_keys,
                                          const DirtySegments& outdated, const RunTreeView& tree,
                                          const NarrowPhase& test, double bound,
                                          const QueryLimits& limits,
                                          std::vector<std::uint64_t>& keys, QueryCounts& counts) {
  const Found found = collect(outdated.tree(), tree, test, bound, limits, false, keys_, counts);
  if (found == Found::TOO_MANY) {
    return found;
  }
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
  return keys.size() > limits.pairs ? Found::TOO_MANY : found;
}

void ContactBatch::evaluate(const std::vector<std::uint64_t>& keys, bool are_all,
                            const NarrowPhase& test, const QueryLimits& limits,
                            QueryResult& result) {
  result.counts.primitive_tests += keys.size();
  result.complete = are_all;
  evaluator_.evaluate(keys, test, limits, result);
}

bool ContactBatch::find(const RunTreeView& a, const RunTreeView& b, const NarrowPhase& test,
                        double moved, const QueryLimits& limits, QueryResult& result) {
  const Found found =
      collect(a, b, test, test.margin() + moved, limits, true, keys_, result.counts);
  if (found == Found::TOO_MANY) {
    return false;
  }
  evaluate(keys_, found == Found::ALL, test, limits, result);
  return true;
}

}  // namespace fiber
