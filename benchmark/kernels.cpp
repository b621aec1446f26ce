#include <algorithm>
#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "benchmark/commands.hpp"
#include "benchmark/pairs/chosen_families.hpp"
#include "benchmark/pairs/pair_score.hpp"
#include "benchmark/pairs/pair_times.hpp"
#include "benchmark/statistics.hpp"
#include "src/tools/progress.hpp"

namespace fiber {
namespace {

using Json = nlohmann::ordered_json;

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
  const std::vector<GuardedAnswer> answers = guarded_answers(*run.kernel, pairs.size());
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

Json time_quantile(const KernelRun& run, double share) {
  return run.times_ns.empty() ? Json() : Json(quantile(run.times_ns, share));
}

Json to_json(const KernelsRequest& request, const std::string& family, std::size_t contacts,
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

void print_row(const Json& row) {
  constexpr int width = 14;
  constexpr int name_width = 26;
  std::cout << std::left << std::setw(name_width) << row["family"].get<std::string>()
            << std::setw(width) << row["kernel"].get<std::string>() << std::right;
  for (const char* const field :
       {"error_units", "relative_error", "false", "missed", "p50_ns", "p99_ns"}) {
    if (row[field].is_number()) {
      std::cout << std::setw(width) << row[field].get<double>();
    } else {
      std::cout << std::setw(width) << '-';
    }
  }
  std::cout << std::setw(width)
            << row["not_finite"].get<int>() + row["no_answer"].get<int>() + row["ended"].get<int>()
            << '\n';
}

void print_heading() {
  std::cout << "family                    kernel          error [eps*M]  relative       false"
               "        missed      p50 [ns]      p99 [ns]     no answer\n";
}

/// All kernels on one family, a row each.
std::vector<Json> rows_of(const KernelsRequest& request, const HardFamily& family) {
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
  std::vector<Json> rows;
  for (const KernelRun& run : runs) {
    rows.push_back(to_json(request, family.name, static_cast<std::size_t>(contacts), run));
  }
  return rows;
}

ExitCode run(const KernelsRequest& request) {
  for (const std::string& name : request.kernels) {
    make_pair_kernel(name);  // refuses before anything is printed
  }
  const std::vector<HardFamily> families = chosen_families(hard_families(), request.families);
  if (!request.json) {
    print_heading();
  }
  Progress progress;
  for (const HardFamily& family : families) {
    progress.show(family.name);
    const std::vector<Json> rows = rows_of(request, family);
    progress.show("");
    for (const Json& row : rows) {
      if (request.json) {
        std::cout << row.dump() << '\n';
      } else {
        print_row(row);
      }
    }
    std::cout.flush();
  }
  return SUCCEEDED;
}

}  // namespace

void add_kernels_command(CLI::App& app, Command& command) {
  const auto request = std::make_shared<KernelsRequest>();
  CLI::App* kernels = app.add_subcommand(
      "kernels",
      "time and error of ways to compute the distance of two segments, on families of hard pairs");
  kernels->callback([&command, request] { command = [request] { return run(*request); }; });
  kernels
      ->add_option("--kernels", request->kernels,
                   "with commas between them, of " + join(pair_kernel_names()))
      ->delimiter(',')
      ->default_str("all");
  kernels->add_option("--families", request->families, "of pairs, with commas between them")
      ->delimiter(',')
      ->default_str("all");
  kernels->add_option("--seed", request->seed, "of the pairs")->capture_default_str();
  kernels->add_option("--pairs", request->pairs, "per family")
      ->check(whole_number(1))
      ->capture_default_str();
  kernels->add_option("--repeats", request->repeats, "of each time, of which the median counts")
      ->check(whole_number(1))
      ->capture_default_str();
  kernels->add_flag("--json", request->json, "JSON Lines instead of a table");
}

}  // namespace fiber
