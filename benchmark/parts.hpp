#pragma once

#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "benchmark/options.hpp"
#include "benchmark/report.hpp"
#include "src/tools/progress.hpp"

namespace fiber {

/// A part of a measurement and what its table shows.
template <class Measurement>
struct MeasurementPart {
  std::string name;
  std::function<void(const Measurement&, const ReportRow&)> measure;
  std::vector<TableColumn> columns;
};

/// Which parts of a measurement are asked for.
template <class Measurement>
struct PartsRequest {
  std::vector<MeasurementPart<Measurement>> all;
  std::vector<std::string> chosen;  ///< names
  Measurement measurement;
  bool json = false;
};

/// Measures the parts that are chosen, and prints rows as they come.
template <class Measurement>
ExitCode run_parts(const PartsRequest<Measurement>& request) {
  Progress progress;
  for (const MeasurementPart<Measurement>& part : request.all) {
    if (std::count(request.chosen.begin(), request.chosen.end(), part.name) == 0) {
      continue;
    }
    RowPrinter printer(part.columns, request.json);
    std::uint64_t count = 0;
    const auto show = [&] { progress.show(part.name + ": " + std::to_string(count) + " rows"); };
    show();
    part.measure(request.measurement, [&](const BenchmarkRow& row) {
      progress.show("");
      if (!request.json && count == 0) {
        std::cout << part.name << '\n';
      }
      BenchmarkRow line{{"part", part.name}};
      line.update(row);
      printer.print(line);
      ++count;
      show();
    });
  }
  return SUCCEEDED;
}

/// Adds the subcommand of a measurement in parts, with --parts and --json.
template <class Measurement>
std::pair<CLI::App*, Measurement&> add_parts_command(
    CLI::App& app, Command& command, const std::string& name, const std::string& description,
    std::vector<MeasurementPart<Measurement>> parts) {
  const auto request = std::make_shared<PartsRequest<Measurement>>();
  request->all = std::move(parts);
  for (const MeasurementPart<Measurement>& part : request->all) {
    request->chosen.push_back(part.name);
  }
  CLI::App* const subcommand =
      add_subcommand(app, command, name, description, request, run_parts<Measurement>);
  add_names(*subcommand, "--parts", request->chosen,
            "with commas between them, of " + join(request->chosen))
      ->check(CLI::IsMember(request->chosen));
  subcommand->add_flag("--json", request->json, "JSON Lines instead of tables");
  return {subcommand, request->measurement};
}

}  // namespace fiber
