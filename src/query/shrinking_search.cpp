#include "src/query/shrinking_search.hpp"

#include "src/query/pair_sinks.hpp"

namespace fiber {
namespace {

/// Hands candidates to the collector of a job, until its round has enough.
class JobSink final : public CollectorSink {
 public:
  JobSink(SearchJob<PairCollector>& job, const Approach& approach)
      : CollectorSink(job.part(), approach), job_(job) {}

  bool offer(PointPair pair) override { return CollectorSink::offer(pair) && job_.goes_on(1024); }

 private:
  SearchJob<PairCollector>& job_;
};

}  // namespace

void ShrinkingSearch::find(const RunTreeView& a, const RunTreeView& b, const Approach& approach,
                           tbb::task_arena& arena, PairCollector& whole, QueryResult& result) {
  constexpr std::uint32_t min_groups = 4;  // of a job
  CollectorSink sink(whole, approach);
  jobs_.search(
      whole, a.group_count(), min_groups, min_groups,
      [&](const auto& work) { arena.execute(work); },
      [&](SearchJob<PairCollector>& job, std::uint32_t begin, std::uint32_t end) {
        JobSink job_sink(job, approach);
        find_near_segments_until([&] { return job.is_over(); }, a, begin, end, b, job_sink,
                                 job.counts().node_tests, job.counts().node_overlaps);
      },
      [&](std::uint32_t begin, std::uint32_t end) {
        find_near_segments_until([&] { return whole.done_by_now(); }, a, begin, end, b, sink,
                                 result.counts.node_tests, result.counts.node_overlaps);
      });
  whole.finish();
}

}  // namespace fiber
