#include <tbb/task_arena.h>

#include <algorithm>

#include "benchmark/environment/measurements.hpp"
#include "fiber_proximity/environment/check_fibers.hpp"
#include "src/accuracy/statistics.hpp"
#include "src/query/threads.hpp"
#include "src/tools/progress.hpp"

namespace fiber {
namespace {

constexpr double step_of_candidates = 0.05;  // [m]

/// A cable and its next state: all of it has moved, one end twice as far as the other.
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

/// A batch of candidates, checked by some threads.
template <class Check>
struct BatchRun {
  std::uint32_t threads;
  std::vector<double> times_ms;
  std::vector<Check> checks;
};

/// Checks all candidates on one thread and on several, in turns.
/// @param check_all check_fibers() or check_motions(), with its options
template <class Check, class Candidates, class CheckAll>
void measure_candidates(const EnvironmentMeasurement& what, const Candidates& candidates,
                        const CheckAll& check_all, const ReportRow& report) {
  const Environment environment(Cell(what.size).objects());
  Surroundings surroundings;
  surroundings.environment = &environment;
  surroundings.self = false;
  BatchRun<Check> runs[]{{1, {}, {}}, {what.questions.threads, {}, {}}};
  Progress progress;
  for (std::uint32_t repeat = 0; repeat < what.repeats; ++repeat) {
    progress.show("batch " + std::to_string(repeat) + " of " + std::to_string(what.repeats));
    for (std::size_t turn = 0; turn < std::size(runs); ++turn) {
      BatchRun<Check>& run = runs[(repeat + turn) % std::size(runs)];
      tbb::task_arena arena(arena_concurrency(run.threads));
      run.times_ms.push_back(time_of(
          [&] { arena.execute([&] { check_all(candidates, surroundings, run.checks); }); }));
    }
  }
  for (const BatchRun<Check>& run : runs) {
    const auto touches = [](const Check& check) { return check.has_contact(); };
    const auto count = static_cast<double>(run.checks.size());
    report({{"threads", run.threads},
            {"per_candidate_ms", median(run.times_ms) / count},
            {"touching", std::count_if(run.checks.begin(), run.checks.end(), touches)},
            {"candidates", what.candidates},
            {"points", what.size.points},
            {"seed", what.seed},
            {"repeats", what.repeats}});
  }
}

/// Checks candidates for any contact.
/// @param make  makes one of so many points, by a seed
/// @param check check_fibers() or check_motions()
template <class Candidate, class Options, class Check>
void measure_first(const EnvironmentMeasurement& what,
                   Candidate (*make)(std::uint32_t points, std::uint64_t seed),
                   void (*check)(const std::vector<Candidate>&, const Surroundings&, const Options&,
                                 std::vector<Check>&),
                   const ReportRow& report) {
  std::vector<Candidate> candidates;
  for (std::uint32_t i = 0; i < what.candidates; ++i) {
    candidates.push_back(make(what.size.points, what.seed + i));
  }
  Options first;
  first.type = decltype(first.type)::FIRST;
  measure_candidates<Check>(
      what, candidates,
      [&](const auto& all, const Surroundings& surroundings, std::vector<Check>& checks) {
        check(all, surroundings, first, checks);
      },
      report);
}

}  // namespace

void measure_batch(const EnvironmentMeasurement& what, const ReportRow& report) {
  measure_first(what, candidate_cable, check_fibers, report);
}

void measure_motions(const EnvironmentMeasurement& what, const ReportRow& report) {
  measure_first(what, candidate_step, check_motions, report);
}

}  // namespace fiber
