#include "src/tools/compare_command.hpp"

#include <chrono>
#include <iostream>
#include <memory>
#include <string>

#include "fiber_proximity/compare/fcl_comparer.hpp"
#include "fiber_proximity/io/fiber_file.hpp"
#include "src/tools/comparison_format.hpp"
#include "src/tools/fiber_options.hpp"

namespace fiber {
namespace {

struct CompareRequest {
  std::string file;
  std::string engine = "run_tree";
  QueryOptions query;
  EngineOptions engine_options;
  double radius = 0.0;  // [m]
  std::string format = "text";
};

void append(std::string& text, const std::string& format, const FrameComparison& frame) {
  if (format == "json") {
    append_json(text, frame);
  } else if (format == "csv") {
    append_csv(text, frame);
  } else {
    append_text(text, frame);
  }
}

/// All disagreements of a file, for its last line.
class Totals {
 public:
  void add(const Comparison& comparison) {
    ++frames_;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      counts_[i] += comparison.count(static_cast<Verdict>(i));
    }
  }

  void append_to(std::string& text) const {
    const auto& [both, ours, fcl, neither] = counts_;
    text += std::to_string(frames_) + (frames_ == 1 ? " frame, " : " frames, ") +
            std::to_string(both + ours + fcl + neither) + " disagreements: ours is right in " +
            std::to_string(ours) + ", FCL in " + std::to_string(fcl) + ", none in " +
            std::to_string(neither) + ", within what both are rounded by " + std::to_string(both) +
            '\n';
  }

  ExitCode exit_code() const {
    const auto& [both, ours, fcl, neither] = counts_;
    return fcl + neither == 0 ? SUCCEEDED : DISAGREED;
  }

 private:
  std::uint64_t frames_ = 0;
  std::array<std::uint64_t, 4> counts_{};  // by Verdict
};

ExitCode run(const CompareRequest& request) {
  const std::unique_ptr<ProximityEngine> engine =
      make_engine(request.engine, request.engine_options);
  const FiberFile file = read_fibers(request.file, request.radius);
  FclComparer comparer;
  Totals totals;
  std::string text = request.format == "csv" ? comparison_csv_header(file.has_frames) : "";
  for (const FiberFrame& frame : file.frames) {
    const auto begin = std::chrono::steady_clock::now();
    engine->update(frame.fibers);
    const std::chrono::duration<double> update = std::chrono::steady_clock::now() - begin;
    const FrameComparison found{file.has_frames ? std::optional(frame.frame) : std::nullopt,
                                update.count(),
                                comparer.compare(frame.fibers, *engine, request.query)};
    totals.add(found.comparison);
    append(text, request.format, found);
    std::cout << text;
    text.clear();
  }
  if (request.format == "text") {
    totals.append_to(text);
  }
  std::cout << text;
  return totals.exit_code();
}

void add_options(CLI::App& app, CompareRequest& request) {
  app.add_option("FILE", request.file, "fibre file (.csv or .hair)")->required();
  app.add_option("--engine", request.engine, "one of " + join(engine_names()))
      ->capture_default_str();
  app.add_option("--radius", request.radius, "of all fibres, if the file has no radii [m]")
      ->capture_default_str();
  app.add_option("--threads", request.engine_options.threads,
                 "most threads for the engine, 0 for as many as there are cores; FCL has one")
      ->check(whole_number(0))
      ->capture_default_str();
  app.add_option("--margin", request.query.margin, "pairs with a gap of at most this; finite [m]")
      ->check(finite_number(0.0))
      ->capture_default_str();
  app.add_option("--neighbour-skip", request.query.neighbour_skip,
                 "segments of a fibre whose indices differ by at most this are no pair; without "
                 "this and the next option, those are that the fibre makes a loop between")
      ->check(whole_number(0));
  app.add_option("--neighbour-skip-length", request.query.neighbour_skip_length,
                 "segments of a fibre with less than this between them are no pair [m]; with one "
                 "of the two given, the other is 1 or 0 m, and no loop is needed")
      ->check(finite_number(0.0));
  add_kernel_option(app, request.query.kernel);
  app.add_option("--format", request.format,
                 "of the output; csv: a line per frame and method, disagreements only counted; "
                 "json: one object per frame; times in seconds")
      ->check(CLI::IsMember({"csv", "json", "text"}))
      ->capture_default_str();
}

}  // namespace

void add_compare(CLI::App& app, Command& command) {
  CLI::App* compare = app.add_subcommand(
      "compare",
      "our contacts beside those of FCL, used as it mostly is and as well as can be: pairs, "
      "distances, times, and who is right by exact arithmetic where they differ; exit 1 if we are "
      "wrong anywhere");
  const auto request = std::make_shared<CompareRequest>();
  add_options(*compare, *request);
  compare->callback([&command, request] { command = [request] { return run(*request); }; });
}

}  // namespace fiber
