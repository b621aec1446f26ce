#include <iostream>
#include <limits>

#include "benchmark/peers/cable_peers.hpp"
#include "benchmark/sim/cable_judge.hpp"
#include "benchmark/sim/measurements.hpp"
#include "benchmark/sim/own_cables.hpp"
#include "benchmark/sim/tip_truth.hpp"
#include "src/accuracy/statistics.hpp"

namespace fiber {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

const char* name_of(CableEnding ending) {
  switch (ending) {
    case CableEnding::ENDED:
      return "ended";
    case CableEnding::DIVERGED:
      return "diverged";
    case CableEnding::DONE:
      break;
  }
  return "done";
}

/// A method's first run, and the time of a second of the scene, the median of all its runs.
struct Measured {
  CableMethod method;
  CableRun run;
  double ms_per_second = unknown;
};

constexpr double longest_ms = 1e4;  // of a run that is repeated

/// Measures in turns, so that a machine that is slower for a while is so for all. What takes very
/// long is not repeated.
std::vector<Measured> measured(const CableScene& scene, const std::vector<CableMethod>& methods,
                               std::uint32_t repeats) {
  std::vector<Measured> found;
  std::vector<std::vector<double>> times(methods.size());
  for (std::uint32_t repeat = 0; repeat < repeats; ++repeat) {
    for (std::size_t i = 0; i < methods.size(); ++i) {
      if (repeat > 0 && found[i].run.ms > longest_ms) {
        continue;
      }
      CableRun run = run_cables(scene, methods[i]);
      if (run.ending == CableEnding::DONE) {
        times[i].push_back(run.ms / scene.seconds);
      }
      if (repeat == 0) {
        found.push_back({methods[i], std::move(run)});
      }
    }
  }
  for (std::size_t i = 0; i < methods.size(); ++i) {
    if (!times[i].empty()) {
      found[i].ms_per_second = median(times[i]);
    }
  }
  return found;
}

/// The time of our own with the default options and as many segments.
double own_time(const std::vector<Measured>& all, int segments) {
  for (const Measured& one : all) {
    if (one.method.method == "own" && one.method.segments == segments) {
      return one.ms_per_second;
    }
  }
  return unknown;
}

BenchmarkRow row_of(const CableScene& scene, const Measured& one,
                    const std::vector<Measured>& all) {
  return {{"scene", scene.name},
          {"method", one.method.method},
          {"setting", one.method.setting},
          {"segments", one.method.segments},
          {"cables", scene.cables.size()},
          {"seconds", scene.seconds},
          {"ending", name_of(one.run.ending)},
          {"reason", one.run.reason},
          {"ms_per_second", one.ms_per_second},
          {"times_own", one.ms_per_second / own_time(all, one.method.segments)}};
}

/// @param error of a run that is DONE
template <class Error>
void measure_scene(const CableScene& scene, const std::vector<int>& segments, std::uint32_t repeats,
                   const Error& error, const ReportRow& report) {
  std::vector<CableMethod> methods = own_cables(scene, segments);
  for (CableMethod& method : peer_cables(scene, segments)) {
    methods.push_back(std::move(method));
  }
  const std::vector<Measured> all = measured(scene, methods, repeats);
  for (const Measured& one : all) {
    const bool done = one.run.ending == CableEnding::DONE;
    const CableVerdict verdict = done ? judge_cables(scene, one.run) : CableVerdict();
    BenchmarkRow row = row_of(scene, one, all);
    row["error"] = done ? error(one.run, verdict) : unknown;
    row["moved"] = done ? verdict.moved : unknown;
    row["speed"] = done ? verdict.speed : unknown;
    row["deepest"] = done ? verdict.deepest : unknown;
    row["passed"] = verdict.passed;
    report(row);
  }
}

}  // namespace

void measure_peers(const SimulationMeasurement& what, const ReportRow& report) {
  for (const std::string& line : missing_cable_peers()) {
    std::cerr << "fiber_bench: " << line << '\n';
  }
  for (const CableScene& scene : {hanging_cable(), cantilever_cable()}) {
    const TipTruth truth(scene, what.reference_segments, what.reference_substeps);
    measure_scene(
        scene, what.peer_segments, what.peer_repeats,
        [&](const CableRun& run, const CableVerdict& /*verdict*/) { return truth.error(run); },
        report);
  }
  measure_scene(
      falling_cables(static_cast<int>(what.peer_cables)), what.peer_cable_segments,
      what.peer_repeats,
      [](const CableRun& /*run*/, const CableVerdict& verdict) { return verdict.depth; }, report);
}

}  // namespace fiber
