#include <tbb/task_arena.h>

#include <algorithm>

#include "benchmark/environment/measurements.hpp"
#include "benchmark/statistics.hpp"
#include "fiber_proximity/environment/check_fibers.hpp"
#include "src/query/threads.hpp"
#include "src/tools/progress.hpp"

namespace fiber {
namespace {

/// Which of the candidates touch something.
class BatchRun {
 public:
  explicit BatchRun(std::uint32_t threads) : threads_(threads) {}

  void measure(const Environment& environment, const std::vector<FiberAssembly>& candidates) {
    Surroundings surroundings;
    surroundings.environment = &environment;
    surroundings.self = false;
    QueryOptions first;
    first.type = QueryType::FIRST;
    tbb::task_arena arena(arena_concurrency(threads_));
    times_ms_.push_back(time_of(
        [&] { arena.execute([&] { check_fibers(candidates, surroundings, first, checks_); }); }));
  }

  BenchmarkRow row() const {
    const auto touches = [](const FiberCheck& check) { return check.has_contact(); };
    return {{"part", "batch"},
            {"threads", threads_},
            {"per_candidate_ms", median(times_ms_) / static_cast<double>(checks_.size())},
            {"touching", std::count_if(checks_.begin(), checks_.end(), touches)}};
  }

 private:
  const std::uint32_t threads_;
  std::vector<double> times_ms_;
  std::vector<FiberCheck> checks_;
};

}  // namespace

std::vector<BenchmarkRow> measure_batch(const EnvironmentMeasurement& what) {
  const Environment environment(Cell(what.size).objects());
  std::vector<FiberAssembly> candidates;
  for (std::uint32_t i = 0; i < what.candidates; ++i) {
    candidates.push_back(candidate_cable(what.size.points, what.seed + i));
  }
  std::vector<BatchRun> runs;
  runs.emplace_back(1);
  runs.emplace_back(what.questions.threads);
  Progress progress;
  for (std::uint32_t repeat = 0; repeat < what.repeats; ++repeat) {
    progress.show("batch " + std::to_string(repeat) + " of " + std::to_string(what.repeats));
    for (std::size_t turn = 0; turn < runs.size(); ++turn) {
      runs[(repeat + turn) % runs.size()].measure(environment, candidates);
    }
  }
  std::vector<BenchmarkRow> rows;
  for (const BatchRun& run : runs) {
    BenchmarkRow row = run.row();
    row["candidates"] = what.candidates;
    row["points"] = what.size.points;
    row["seed"] = what.seed;
    row["repeats"] = what.repeats;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace fiber
