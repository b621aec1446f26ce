#include "src/query/shrinking_search.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <limits>

#include "src/query/pair_sinks.hpp"

namespace fiber {
namespace {

constexpr std::uint32_t least_groups = 4;  // of a job
constexpr std::uint32_t least_jobs = 4;    // fewer are not worth waking threads

/// What the jobs of a round know of each other.
class Round {
 public:
  explicit Round(const PairCollector& whole)
      : pairs_left_(whole.pairs_left()), wants_any_(whole.wants_any()) {}

  /// Whether what this job finds is not needed any more.
  bool is_over(std::uint32_t job) const {
    return lacks_pairs() || job > enough_.load(std::memory_order_relaxed);
  }

  void take_pairs(std::uint64_t count) { taken_.fetch_add(count, std::memory_order_relaxed); }
  /// Whether more pairs have come up than are left. Without a contact that is enough this does not
  /// depend on the threads.
  bool lacks_pairs() const { return taken_.load(std::memory_order_relaxed) > pairs_left_; }

  /// Notes that the job has found one, if that is enough.
  void end(std::uint32_t job, PairCollector& part) {
    if (wants_any_ && part.done()) {
      std::uint32_t first = enough_.load(std::memory_order_relaxed);
      while (job < first && !enough_.compare_exchange_weak(first, job)) {
      }
    }
  }

 private:
  const std::uint64_t pairs_left_;
  const bool wants_any_;
  std::atomic<std::uint64_t> taken_{0};
  std::atomic<std::uint32_t> enough_{std::numeric_limits<std::uint32_t>::max()};
};

/// Hands candidates to the collector of a job, until its round has enough.
class PartSink final : public CollectorSink {
 public:
  PartSink(PairCollector& part, double moved, Round& round, std::uint32_t job)
      : CollectorSink(part, moved), part_(part), round_(round), job_(job) {}

  bool offer(PointPair pair) override {
    return CollectorSink::offer(pair) && (++offered_ % steps_between_looks != 0 || look());
  }

  /// Tells the round what pairs the job has taken. @returns whether to go on
  bool look() {
    const std::uint64_t taken = part_.pairs_taken() + (part_.lacks_pairs() ? 1 : 0);
    round_.take_pairs(taken - told_);
    told_ = taken;
    return !round_.is_over(job_);
  }

 private:
  static constexpr std::uint32_t steps_between_looks =
      1024;  // threads wait for each other to count

  PairCollector& part_;
  Round& round_;
  const std::uint32_t job_;
  std::uint32_t offered_ = 0;
  std::uint64_t told_ = 0;
};

}  // namespace

void ShrinkingSearch::find(const RunTreeView& a, const RunTreeView& b, double moved,
                           tbb::task_arena& arena, PairCollector& whole, QueryResult& result) {
  CollectorSink sink(whole, moved);
  const std::uint32_t groups = a.group_count();
  std::uint32_t size = least_groups;
  for (std::uint32_t begin = 0; begin < groups && !whole.done_by_now();) {
    const std::uint32_t end = std::min(groups, begin + size);
    if (!find_together(a, b, moved, arena, begin, end, whole)) {
      find_near_segments_until([&] { return whole.done_by_now(); }, a, begin, end, b, sink,
                               result.counts.node_tests, result.counts.node_overlaps);
    }
    begin = end;
    size = begin;
  }
  whole.finish();
}

/// Searches the groups of a round as jobs of their own.
/// @return false, with nothing found, if they are few, or where more pairs come up than are left
bool ShrinkingSearch::find_together(const RunTreeView& a, const RunTreeView& b, double moved,
                                    tbb::task_arena& arena, std::uint32_t begin, std::uint32_t end,
                                    PairCollector& whole) {
  const std::uint32_t groups = std::max(least_groups, (end - begin + most_jobs - 1) / most_jobs);
  const std::uint32_t jobs = (end - begin + groups - 1) / groups;
  if (jobs < least_jobs) {
    return false;
  }
  for (std::uint32_t job = 0; job < jobs; ++job) {
    jobs_[job].part.emplace(whole, jobs_[job].result);
  }
  Round round(whole);
  const auto find_part = [&](std::uint32_t job) {
    PairCollector& part = *jobs_[job].part;
    PartSink sink(part, moved, round, job);
    const std::uint32_t first = begin + job * groups;
    QueryCounts& counts = jobs_[job].result.counts;
    find_near_segments_until([&] { return round.is_over(job) || part.done_by_now(); }, a, first,
                             std::min(end, first + groups), b, sink, counts.node_tests,
                             counts.node_overlaps);
    sink.look();
    round.end(job, part);
  };
  arena.execute([&] { tbb::parallel_for(std::uint32_t{0}, jobs, find_part); });
  if (round.lacks_pairs()) {
    return false;
  }
  for (std::uint32_t job = 0; job < jobs && !whole.done_by_now(); ++job) {
    whole.absorb(*jobs_[job].part);
  }
  return true;
}

}  // namespace fiber
