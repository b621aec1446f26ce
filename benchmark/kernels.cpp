#include <algorithm>
#include <iostream>
#include <memory>

#include "benchmark/commands.hpp"
#include "benchmark/kernels/chosen_families.hpp"
#include "benchmark/kernels/pair_score.hpp"
#include "benchmark/kernels/pair_times.hpp"
#include "benchmark/options.hpp"
#include "benchmark/report.hpp"
#include "src/accuracy/statistics.hpp"
#include "src/tools/progress.hpp"

namespace fiber {
namespace {

struct KernelsRequest {
  std::vector<std::string> kernels = pair_kernel_names();
  std::vector<std::string> families;  // none: all
  std::uint64_t seed = 1;
  std::uint32_t pairs = 200;
  std::uint32_t repeats = 11;
  bool json = false;
};

/// One kernel on the pairs of one family.
struct KernelRun {
  std::string name;
  std::unique_ptr<PairKernel> kernel;
  std::vector<HardPair> survived;  // the pairs that do not end the process
  PairScore score;
  std::vector<double> times_ns;
};

void judge(KernelRun& run, const std::vector<HardPair>& pairs,
           const std::vector<PairTruth>& truths) {
  run.kernel->prepare(pairs);
  const std::vector<Guarded<PairAnswer>> answers = guarded_answers(*run.kernel, pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    run.score.add(pairs[i], truths[i], answers[i]);
    if (answers[i].outcome != Outcome::ENDED) {
      run.survived.push_back(pairs[i]);
    }
  }
}

void measure(std::vector<KernelRun>& runs, std::uint32_t repeats) {
  std::vector<TimedKernel> timed;
  for (KernelRun& run : runs) {
    timed.push_back({run.kernel.get(), std::move(run.survived)});
  }
  std::vector<std::vector<double>> times = pair_times_ns(std::move(timed), repeats);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    runs[i].times_ns = std::move(times[i]);
  }
}

BenchmarkRow time_quantile(const KernelRun& run, double share) {
  return run.times_ns.empty() ? BenchmarkRow() : BenchmarkRow(quantile(run.times_ns, share));
}

BenchmarkRow to_json(const KernelsRequest& request, const std::string& family, std::size_t contacts,
                     const KernelRun& run) {
  constexpr double middle = 0.5;
  constexpr double high = 0.99;
  const PairScore& score = run.score;
  return {{"family", family},
          {"seed", request.seed},
          {"pairs", request.pairs},
          {"repeats", request.repeats},
          {"kernel", run.name},
          {"contacts", contacts},
          {"answered", score.answered()},
          {"error", score.error()},
          {"error_units", score.error_units()},
          {"relative_error", score.relative_error()},
          {"false", score.false_contacts()},
          {"missed", score.missed_contacts()},
          {"plain_false", score.plain_false_contacts()},
          {"plain_missed", score.plain_missed_contacts()},
          {"outside_bounds", score.outside_bounds()},
          {"not_finite", score.not_finite()},
          {"no_answer", score.no_answer()},
          {"ended", score.ended()},
          {"p50_ns", time_quantile(run, middle)},
          {"p99_ns", time_quantile(run, high)}};
}

/// All kernels on one family, a row each.
std::vector<BenchmarkRow> rows_of(const KernelsRequest& request, const HardFamily& family) {
  const std::vector<HardPair> pairs = hard_pairs(family, request.pairs, request.seed);
  std::vector<PairTruth> truths;
  for (const HardPair& pair : pairs) {
    truths.emplace_back(pair);
  }
  std::vector<KernelRun> runs;
  for (const std::string& name : request.kernels) {
    runs.push_back({name, make_pair_kernel(name), {}, {}, {}});
    judge(runs.back(), pairs, truths);
  }
  measure(runs, request.repeats);
  const auto contacts = std::count_if(truths.begin(), truths.end(),
                                      [](const PairTruth& truth) { return truth.contact; });
  std::vector<BenchmarkRow> rows;
  for (const KernelRun& run : runs) {
    rows.push_back(to_json(request, family.name, static_cast<std::size_t>(contacts), run));
  }
  return rows;
}

ExitCode run_kernels(const KernelsRequest& request) {
  for (const std::string& name : request.kernels) {
    make_pair_kernel(name);  // refuses before anything is printed
  }
  RowPrinter printer({"family",
                      "kernel",
                      {"error [eps*M]", "error_units"},
                      {"relative", "relative_error"},
                      "false",
                      "missed",
                      {"p50 [ns]", "p50_ns"},
                      {"p99 [ns]", "p99_ns"},
                      "not_finite",
                      "no_answer",
                      "ended"},
                     request.json);
  Progress progress;
  for (const HardFamily& family : chosen_families(hard_families(), request.families)) {
    progress.show(family.name);
    const std::vector<BenchmarkRow> rows = rows_of(request, family);
    progress.show("");
    for (const BenchmarkRow& row : rows) {
      printer.print(row);
    }
  }
  return SUCCEEDED;
}

}  // namespace

void add_kernels_command(CLI::App& app, Command& command) {
  const auto request = std::make_shared<KernelsRequest>();
  CLI::App* const kernels = add_subcommand(
      app, command, "kernels",
      "time and error of ways to compute the distance of two segments, on families of hard pairs",
      request, run_kernels);
  add_names(*kernels, "--kernels", request->kernels,
            "with commas between them, of " + join(pair_kernel_names()));
  add_names(*kernels, "--families", request->families, "of pairs, with commas between them");
  add_value(*kernels, "--seed", request->seed, "of the pairs");
  add_count(*kernels, "--pairs", request->pairs, "per family");
  add_count(*kernels, "--repeats", request->repeats, "of each time, of which the median counts");
  kernels->add_flag("--json", request->json, "JSON Lines instead of a table");
}

}  // namespace fiber
