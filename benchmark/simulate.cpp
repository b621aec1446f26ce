#include <algorithm>
#include <functional>
#include <iomanip>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "benchmark/commands.hpp"
#include "benchmark/sim/measurements.hpp"
#include "src/tools/progress.hpp"

namespace fiber {
namespace {

/// A part of the measurement and what its table shows.
struct Part {
  std::string name;
  std::function<void(const SimulationMeasurement&, const ReportRow&)> measure;
  std::vector<std::string> columns;
};

const std::vector<Part>& parts() {
  const std::vector<std::string> hose_columns{
      "method",         "motion",     "segments", "substeps",    "residual",
      "max_iterations", "iterations", "error",    "ms_per_step", "ms_per_second"};
  const std::vector<std::string> xpbd_columns{"method",   "motion", "segments",    "inertia",
                                              "substeps", "error",  "ms_per_step", "ms_per_second"};
  static const std::vector<Part> all{
      {"validation",
       measure_validation,
       {"test", "scene", "quantity", "segments", "theory", "simulated", "error"}},
      {"convergence", measure_convergence, hose_columns},
      {"xpbd", measure_xpbd, xpbd_columns},
      {"peers",
       measure_peers,
       {"scene", "method", "setting", "segments", "ending", "error", "deepest", "passed",
        "ms_per_second", "times_own"}},
      {"effects",
       measure_effect_costs,
       {"added", "ms_per_step", "us_per_node_step", "bytes_per_node", "unknowns_per_node"}},
      {"real_time",
       measure_real_time,
       {"scene", "rods", "segments", "substeps", "threads", "ms_per_step", "us_per_node_step",
        "real_time_factor"}}};
  return all;
}

std::vector<std::string> part_names() {
  std::vector<std::string> names;
  for (const Part& part : parts()) {
    names.push_back(part.name);
  }
  return names;
}

struct SimulateRequest {
  std::vector<std::string> parts = part_names();
  SimulationMeasurement measurement;
  bool json = false;
};

constexpr int width = 28;

void print_header(const Part& part) {
  std::cout << part.name << '\n';
  for (const std::string& column : part.columns) {
    std::cout << std::setw(width) << column;
  }
  std::cout << '\n';
}

void print_row(const Part& part, const SimulationRow& row) {
  for (const std::string& column : part.columns) {
    const SimulationRow& value = row.at(column);
    std::cout << std::setw(width);
    if (value.is_string()) {
      std::cout << value.get<std::string>();
    } else {
      std::cout << value.get<double>();
    }
  }
  std::cout << '\n';
}

/// Rows come one by one: what is measured last takes longest.
ExitCode run(const SimulateRequest& request) {
  Progress progress;
  for (const Part& part : parts()) {
    if (std::count(request.parts.begin(), request.parts.end(), part.name) == 0) {
      continue;
    }
    if (!request.json) {
      print_header(part);
    }
    int count = 0;
    const auto show = [&] { progress.show(part.name + ": " + std::to_string(count) + " done"); };
    show();
    part.measure(request.measurement, [&](const SimulationRow& row) {
      progress.show("");
      if (request.json) {
        SimulationRow line{{"part", part.name}};
        line.update(row);
        std::cout << line.dump() << '\n' << std::flush;
      } else {
        print_row(part, row);
      }
      ++count;
      show();
    });
  }
  return SUCCEEDED;
}

void add_counts(CLI::App& app, const std::string& name, std::vector<int>& values,
                const std::string& meaning, std::uint64_t least = 1) {
  app.add_option(name, values, meaning + ", with commas between them")
      ->delimiter(',')
      ->check(whole_number(least))
      ->capture_default_str();
}

template <class Count>
void add_count(CLI::App& app, const std::string& name, Count& value, const std::string& meaning,
               std::uint64_t least = 1) {
  app.add_option(name, value, meaning)->check(whole_number(least))->capture_default_str();
}

}  // namespace

void add_simulate_command(CLI::App& app, Command& command) {
  const auto request = std::make_shared<SimulateRequest>();
  SimulationMeasurement& what = request->measurement;
  CLI::App* simulate = app.add_subcommand(
      "simulate",
      "the simulation: what theory says, error and time by segments and steps, beside a "
      "textbook's XPBD rod and beside Bullet and MuJoCo, what each effect costs, on one thread, in "
      "processor time; and how many times faster than the clock large scenes are");
  simulate->callback([&command, request] { command = [request] { return run(*request); }; });
  simulate
      ->add_option("--parts", request->parts, "with commas between them, of " + join(part_names()))
      ->delimiter(',')
      ->check(CLI::IsMember(part_names()))
      ->default_str("all");
  add_counts(*simulate, "--segments", what.segments, "of the hose");
  add_counts(*simulate, "--substeps", what.substeps, "of a frame");
  simulate
      ->add_option("--residuals", what.residuals,
                   "that a step may leave [m/s], with commas between them")
      ->delimiter(',')
      ->check(finite_number(1e-12))
      ->capture_default_str();
  add_counts(*simulate, "--max-iterations", what.max_iterations, "the most of a step");
  add_counts(*simulate, "--xpbd-segments", what.xpbd_segments, "of the XPBD hose");
  add_counts(*simulate, "--xpbd-substeps", what.xpbd_substeps, "of its frames");
  add_counts(*simulate, "--xpbd-inertias", what.xpbd_inertias,
             "of its cross-sections, times what they have");
  add_count(*simulate, "--frames", what.frames,
            "of the swinging hose; the settling one has twice as many");
  add_count(*simulate, "--reference-segments", what.reference_segments,
            "of what the hose is compared with, and half as many", 2);
  add_count(*simulate, "--reference-substeps", what.reference_substeps, "likewise", 2);
  simulate->add_option("--least-ms", what.least_ms, "what is faster is measured again and again")
      ->check(finite_number(0.0))
      ->capture_default_str();
  add_counts(*simulate, "--peer-segments", what.peer_segments,
             "of a cable beside Bullet and MuJoCo");
  add_counts(*simulate, "--peer-cable-segments", what.peer_cable_segments,
             "of cables that touch, beside these");
  add_count(*simulate, "--peer-cables", what.peer_cables, "that touch, beside these");
  add_count(*simulate, "--peer-repeats", what.peer_repeats, "of each time of these");
  add_count(*simulate, "--cables", what.effects.cables, "on which effects are weighed");
  add_count(*simulate, "--cable-segments", what.effects.segments, "of each of these");
  add_count(*simulate, "--cable-frames", what.effects.frames, "to measure of these");
  add_count(*simulate, "--load-cables", what.loads.cables, "in contact, with friction");
  add_count(*simulate, "--load-rods", what.loads.rods, "without contact");
  add_count(*simulate, "--load-frames", what.loads.frames, "to time of each of these");
  add_counts(*simulate, "--load-substeps", what.loads.substeps, "of these frames");
  add_counts(*simulate, "--load-threads", what.loads.threads, "to move these with", 0);
  simulate->add_flag("--json", request->json, "JSON Lines instead of tables");
}

}  // namespace fiber
