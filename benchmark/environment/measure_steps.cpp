#include <tbb/task_arena.h>

#include <algorithm>

#include "benchmark/environment/measurements.hpp"
#include "benchmark/statistics.hpp"
#include "fiber_proximity/environment/check_fibers.hpp"
#include "src/query/threads.hpp"
#include "src/tools/progress.hpp"

namespace fiber {
namespace {

constexpr double step_of_candidates = 0.05;  // [m]

/// A cable, and where its next state is: all of it moved, one end twice as far as the other.
FiberPath candidate_step(std::uint32_t points, std::uint64_t seed) {
  const FiberAssembly before = candidate_cable(points, seed);
  const FiberAssembly other = candidate_cable(points, seed + 1);
  const Eigen::Vector3d way =
      step_of_candidates * (other.points().back() - other.points().front()).normalized();
  std::vector<Eigen::Vector3d> moved = before.points();
  for (std::uint32_t i = 0; i < points; ++i) {
    moved[i] += (1.0 + static_cast<double>(i) / points) / 2.0 * way;
  }
  FiberAssembly after = before;
  after.update_points(moved);
  return {before, after};
}

/// Which of the motions touch something on their way.
class StepsRun {
 public:
  explicit StepsRun(std::uint32_t threads) : threads_(threads) {}

  void measure(const Environment& environment, const std::vector<FiberPath>& motions) {
    Surroundings surroundings;
    surroundings.environment = &environment;
    surroundings.self = false;
    MotionOptions first;
    first.type = MotionType::FIRST;
    tbb::task_arena arena(arena_concurrency(threads_));
    times_ms_.push_back(time_of(
        [&] { arena.execute([&] { check_motions(motions, surroundings, first, checks_); }); }));
  }

  BenchmarkRow row() const {
    const auto touches = [](const MotionCheck& check) { return check.has_contact(); };
    return {{"part", "motions"},
            {"threads", threads_},
            {"per_candidate_ms", median(times_ms_) / static_cast<double>(checks_.size())},
            {"touching", std::count_if(checks_.begin(), checks_.end(), touches)}};
  }

 private:
  const std::uint32_t threads_;
  std::vector<double> times_ms_;
  std::vector<MotionCheck> checks_;
};

}  // namespace

std::vector<BenchmarkRow> measure_steps(const EnvironmentMeasurement& what) {
  const Environment environment(Cell(what.size).objects());
  std::vector<FiberPath> motions;
  for (std::uint32_t i = 0; i < what.candidates; ++i) {
    motions.push_back(candidate_step(what.size.points, what.seed + i));
  }
  std::vector<StepsRun> runs;
  runs.emplace_back(1);
  runs.emplace_back(what.questions.threads);
  Progress progress;
  for (std::uint32_t repeat = 0; repeat < what.repeats; ++repeat) {
    progress.show("motions " + std::to_string(repeat) + " of " + std::to_string(what.repeats));
    for (std::size_t turn = 0; turn < runs.size(); ++turn) {
      runs[(repeat + turn) % runs.size()].measure(environment, motions);
    }
  }
  std::vector<BenchmarkRow> rows;
  for (const StepsRun& run : runs) {
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
