#include <algorithm>
#include <functional>
#include <iomanip>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "benchmark/commands.hpp"
#include "benchmark/environment/measurements.hpp"

namespace fiber {
namespace {

/// A part of the measurement and what its table shows.
struct Part {
  std::string name;
  std::function<std::vector<BenchmarkRow>(const EnvironmentMeasurement&)> measure;
  std::vector<std::string> columns;
};

const std::vector<Part>& parts() {
  static const std::vector<Part> all{
      {"cell",
       measure_cell,
       {"checker", "objects_ms", "cables_ms", "self_ms", "contacts_ms", "nearest_ms", "sum_ms",
        "times_own", "self_contacts", "contacts", "missed", "unwanted"}},
      {"octree", measure_octree, {"resolution", "build_ms", "cells"}},
      {"batch", measure_batch, {"threads", "per_candidate_ms", "touching"}},
      {"motions", measure_steps, {"threads", "per_candidate_ms", "touching"}}};
  return all;
}

std::vector<std::string> part_names() {
  std::vector<std::string> names;
  for (const Part& part : parts()) {
    names.push_back(part.name);
  }
  return names;
}

struct EnvironmentRequest {
  std::vector<std::string> parts = part_names();
  EnvironmentMeasurement measurement;
  bool json = false;
};

void print_table(const Part& part, const std::vector<BenchmarkRow>& rows) {
  constexpr int width = 18;
  std::cout << part.name << '\n';
  for (const std::string& column : part.columns) {
    std::cout << std::setw(width) << column;
  }
  std::cout << '\n';
  for (const BenchmarkRow& row : rows) {
    for (const std::string& column : part.columns) {
      const BenchmarkRow& value = row[column];
      std::cout << std::setw(width);
      if (value.is_string()) {
        std::cout << value.get<std::string>();
      } else {
        std::cout << value.get<double>();
      }
    }
    std::cout << '\n';
  }
}

ExitCode run(const EnvironmentRequest& request) {
  for (const Part& part : parts()) {
    if (std::count(request.parts.begin(), request.parts.end(), part.name) == 0) {
      continue;
    }
    const std::vector<BenchmarkRow> rows = part.measure(request.measurement);
    if (!request.json) {
      print_table(part, rows);
      continue;
    }
    for (const BenchmarkRow& row : rows) {
      std::cout << row.dump() << '\n';
    }
    std::cout.flush();
  }
  return SUCCEEDED;
}

void add_count(CLI::App& app, const std::string& name, std::uint32_t& value,
               const std::string& meaning, std::uint64_t least = 1) {
  app.add_option(name, value, meaning)->check(whole_number(least))->capture_default_str();
}

}  // namespace

void add_environment_command(CLI::App& app, Command& command) {
  const auto request = std::make_shared<EnvironmentRequest>();
  EnvironmentMeasurement& what = request->measurement;
  CLI::App* environment = app.add_subcommand(
      "environment",
      "what the objects around cables cost: a cell with a robot, checked in "
      "every frame beside FCL; "
      "octrees of a depth camera's cloud; candidate cables, and their motions, checked in a batch");
  environment->callback([&command, request] { command = [request] { return run(*request); }; });
  environment
      ->add_option("--parts", request->parts, "with commas between them, of " + join(part_names()))
      ->delimiter(',')
      ->check(CLI::IsMember(part_names()))
      ->default_str("all");
  add_count(*environment, "--cables", what.size.cables, "in the cell");
  add_count(*environment, "--points", what.size.points, "of each cable", 2);
  add_count(*environment, "--triangles", what.size.triangles, "of each of the eight links, about");
  environment->add_option("--margin", what.questions.margin, "within which pairs are contacts [m]")
      ->check(finite_number(0.0))
      ->capture_default_str();
  add_count(*environment, "--pixels", what.pixels, "of the depth camera");
  add_count(*environment, "--candidates", what.candidates, "in the batch");
  add_count(*environment, "--repeats", what.repeats, "frames of the cell, repeats of the others");
  add_count(*environment, "--threads", what.questions.threads, "most threads to use");
  environment->add_option("--seed", what.seed, "of the cloud and the candidates")
      ->check(whole_number(0))
      ->capture_default_str();
  environment->add_flag("--json", request->json, "JSON Lines instead of tables");
}

}  // namespace fiber
