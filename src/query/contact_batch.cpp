#include "src/query/contact_batch.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <limits>

#include "src/bounds/bounding_volume.hpp"
#include "src/hierarchy/run_tree_kernels.hpp"
#include "src/hierarchy/sort_keys.hpp"
#include "src/query/threads.hpp"

namespace fiber {
namespace {

constexpr std::uint32_t groups_per_job = 32;

// Judging what has been found takes a quarter of the time, or more where it is much.
constexpr double part_to_collect = 2.0 / 3.0;
// On one thread, with what sorts it; more than it takes, as what is not sorted cannot be judged.
constexpr double seconds_to_judge_one = 3e-7;

/// The candidates that all threads come by, and whether to look for more.
class CandidateCount {
 public:
  explicit CandidateCount(const QueryLimits& limits)
      : limits_(limits), seconds_for_one_(seconds_to_judge_one / thread_count()) {}

  void add(std::uint64_t count) { count_.fetch_add(count, std::memory_order_relaxed); }

  /// Once and for all: whether it comes to that does not depend on the threads.
  bool is_too_much() const { return count() > limits_.pairs; }

  /// Whether it is time to judge those that there are.
  bool is_late() const {
    return limits_.deadline.has_passed(part_to_collect) ||
           limits_.deadline.has_passed(ContactEvaluator::part_of_time,
                                       seconds_for_one_ * static_cast<double>(count()));
  }

 private:
  static double thread_count() { return tbb::this_task_arena::max_concurrency(); }
  std::uint64_t count() const { return count_.load(std::memory_order_relaxed); }

  const QueryLimits& limits_;
  const double seconds_for_one_;
  std::atomic<std::uint64_t> count_{0};
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
  ~CandidateSink() override { count_.add(uncounted_); }

  bool offer(PointPair candidate) override {
    const PointPair pair = test_.ordered(candidate);
    if (!test_.is_left_out(pair)) {
      keys_.push_back(pair_key(pair));
    }
    return ++uncounted_ < uncounted_at_most || count_and_go_on();
  }

  PairBound bound() const override { return {bound_}; }
  bool bound_shrinks() const override { return false; }

  bool wants_adjacent() const override { return test_.wants_adjacent(); }
  PointRange ruled_out_with(std::uint32_t point) const override {
    return prunes_ ? test_.ruled_out_with(point) : PointRange{};
  }

 private:
  static constexpr std::uint32_t uncounted_at_most = 1024;  // threads wait for each other to count

  bool count_and_go_on() {
    count_.add(uncounted_);
    uncounted_ = 0;
    return !count_.is_too_much() && !count_.is_late();
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
  CandidateCount count(limits);
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
      job.complete =
          !count.is_late() && find_near_segments(a, group, std::min(end, group + step), b, sink,
                                                 job.counts.node_tests, job.counts.node_overlaps);
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

SearchSize ContactBatch::estimate(const RunTreeView& tree, const NarrowPhase& test, double bound,
                                  double max_pairs, bool prunes) {
  constexpr std::uint32_t min_groups = 32;  // a larger part tells more than costs need
  constexpr std::uint32_t max_groups = 96;
  constexpr std::uint32_t part = 64;
  constexpr double max_counted = 1U << 18U;
  const std::uint32_t groups = tree.group_count();
  const std::uint32_t wanted = std::clamp(groups / part, min_groups, max_groups);
  const std::uint32_t stride = std::max(1U, groups / wanted);
  const std::uint32_t first = stride / 2;
  const std::uint32_t searched = groups <= first ? 0 : (groups - first + stride - 1) / stride;
  if (searched == 0) {
    return {};
  }
  const double scale = static_cast<double>(groups) / searched;
  QueryLimits limits{QueryOptions()};
  limits.pairs = static_cast<std::uint64_t>(std::min(max_counted, max_pairs / scale));
  CandidateCount count(limits);
  jobs_.resize(std::max<std::size_t>(jobs_.size(), searched));
  for_each_of(searched, [&](std::size_t index) {
    Job& job = jobs_[index];
    job.keys.clear();
    job.counts = {};
    const std::uint32_t group = first + static_cast<std::uint32_t>(index) * stride;
    CandidateSink sink(test, round_up(bound), prunes, count, job.keys);
    if (!count.is_too_much()) {
      find_near_segments(tree, group, group + 1, tree, sink, job.counts.node_tests,
                         job.counts.node_overlaps);
    }
  });
  if (count.is_too_much()) {  // how many have been found depends on the threads
    return {0.0, scale * static_cast<double>(limits.pairs + 1), 1.0 / scale};
  }
  SearchSize size{0.0, 0.0, 1.0 / scale};
  for (std::uint32_t index = 0; index < searched; ++index) {
    size.overlaps += scale * static_cast<double>(jobs_[index].counts.node_overlaps);
    size.pairs += scale * static_cast<double>(jobs_[index].keys.size());
  }
  return size;
}

ContactBatch::Found ContactBatch::replace(const std::vector<std::uint64_t>& old_keys,
                                          const DirtySegments& dirty, const RunTreeView& tree,
                                          const NarrowPhase& test, double bound,
                                          const QueryLimits& limits,
                                          std::vector<std::uint64_t>& keys, QueryCounts& counts) {
  const Found found = collect(dirty.tree(), tree, test, bound, limits, false, keys_, counts);
  if (found == Found::TOO_MANY) {
    return found;
  }
  // Pairs of two dirty segments are found from both sides.
  keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
  keys.clear();
  auto next = keys_.begin();
  for (const std::uint64_t key : old_keys) {
    const PointPair pair = pair_of(key);
    if (dirty.contains(pair.a) || dirty.contains(pair.b)) {
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
                        const Approach& approach, const QueryLimits& limits, QueryResult& result) {
  const Found found =
      collect(a, b, test, approach.before(test.margin()), limits, true, keys_, result.counts);
  if (found == Found::TOO_MANY) {
    return false;
  }
  evaluate(keys_, found == Found::ALL, test, limits, result);
  return true;
}

}  // namespace fiber
