#include <algorithm>
#include <functional>
#include <iomanip>
#include <iostream>
#include <memory>

#include "benchmark/commands.hpp"
#include "benchmark/continuous/measurements.hpp"
#include "fiber_proximity/scenes/scene.hpp"
#include "src/tools/progress.hpp"

namespace fiber {
namespace {

/// A part of the measurement and what its table shows.
struct MotionPart {
  std::string name;
  std::function<void(const MotionMeasurement&, const ReportMotionRow&)> measure;
  std::vector<std::string> columns;
};

const std::vector<MotionPart>& motion_parts() {
  static const std::vector<MotionPart> all{
      {"times",
       measure_motion_times,
       {"family", "kernel", "tolerance", "misses", "start_misses", "false_alarms", "late", "early",
        "ended", "rejected_ns", "hit_ns"}},
      {"known",
       measure_known_motions,
       {"tolerance", "motions", "contacts", "contacts_missed", "contacts_invented", "near_hits"}},
      {"accuracy",
       measure_motion_accuracy,
       {"family", "tolerance", "motions", "hits", "misses", "false_alarms", "wrongly_certain",
        "wide", "without_upper", "undecided"}},
      {"scenes",
       measure_scene_motions,
       {"scene", "way", "method", "frames", "contacts", "missed", "candidates", "time_ms",
        "times_discrete"}}};
  return all;
}

std::vector<std::string> motion_part_names() {
  std::vector<std::string> names;
  for (const MotionPart& part : motion_parts()) {
    names.push_back(part.name);
  }
  return names;
}

struct MotionsRequest {
  std::vector<std::string> parts = motion_part_names();
  MotionMeasurement measurement;
  bool json = false;
};

void print_cells(const MotionPart& part,
                 const std::function<void(const std::string& column)>& print_cell) {
  constexpr int width = 18;
  constexpr int name_width = 22;
  for (const std::string& column : part.columns) {
    const bool is_name =
        column == "family" || column == "kernel" || column == "scene" || column == "method";
    std::cout << (is_name ? std::left : std::right) << std::setw(is_name ? name_width : width);
    print_cell(column);
  }
  std::cout << '\n';
}

void print_motion_row(const MotionPart& part, const MotionRow& row) {
  print_cells(part, [&](const std::string& column) {
    const MotionRow& value = row.at(column);
    if (value.is_string()) {
      std::cout << value.get<std::string>();
    } else if (value.is_null()) {
      std::cout << '-';
    } else {
      std::cout << value.get<double>();
    }
  });
}

/// Rows come one by one. Those in child processes come first: then no other thread has run.
ExitCode run(const MotionsRequest& request) {
  Progress progress;
  for (const MotionPart& part : motion_parts()) {
    if (std::count(request.parts.begin(), request.parts.end(), part.name) == 0) {
      continue;
    }
    std::uint64_t count = 0;
    const auto show = [&] { progress.show(part.name + ": " + std::to_string(count) + " rows"); };
    show();
    part.measure(request.measurement, [&](const MotionRow& row) {
      progress.show("");
      if (request.json) {
        MotionRow line{{"part", part.name}};
        line.update(row);
        std::cout << line.dump() << '\n' << std::flush;
      } else {
        if (count == 0) {
          std::cout << part.name << '\n';
          print_cells(part, [](const std::string& column) { std::cout << column; });
        }
        print_motion_row(part, row);
      }
      ++count;
      show();
    });
  }
  return SUCCEEDED;
}

}  // namespace

void add_motions_command(CLI::App& app, Command& command) {
  const auto request = std::make_shared<MotionsRequest>();
  MotionMeasurement& what = request->measurement;
  CLI::App* motions = app.add_subcommand(
      "motions",
      "when moving capsules first touch, on families of hard motions: our answers judged against "
      "the truth, and decisions and times of other libraries beside ours");
  motions->callback([&command, request] { command = [request] { return run(*request); }; });
  const auto add_names = [motions](const std::string& name, std::vector<std::string>& values,
                                   const std::string& meaning) {
    return motions->add_option(name, values, meaning)->delimiter(',')->default_str("all");
  };
  const auto add_count = [motions](const std::string& name, std::uint32_t& value,
                                   const std::string& meaning) {
    motions->add_option(name, value, meaning)->check(whole_number(1))->capture_default_str();
  };
  add_names("--parts", request->parts, "with commas between them, of " + join(motion_part_names()))
      ->check(CLI::IsMember(motion_part_names()));
  add_names("--kernels", what.kernels,
            "with commas between them, of " + join(motion_kernel_names()));
  motions->add_option("--families", what.families, "of motions, one after the other")
      ->default_str("all");
  motions->add_option("--seed", what.seed, "of the motions")->capture_default_str();
  motions
      ->add_option("--tolerances", what.tolerances,
                   "of our answers, parts of a motion's extent, with commas between them")
      ->delimiter(',')
      ->check(finite_number(0.0))
      ->capture_default_str();
  add_count("--count", what.count,
            "motions to judge, per family and tolerance; a hundredth of those without thickness");
  add_count("--threads", what.threads, "to judge with");
  motions
      ->add_option("--tolerance", what.tolerance,
                   "to judge other libraries by, a part of the extent")
      ->check(finite_number(0.0))
      ->capture_default_str();
  add_count("--timed", what.timed, "motions per family that all kernels are asked about");
  add_count("--repeats", what.repeats, "of each time, of which the median counts");
  motions
      ->add_option("--scenes", what.scenes, "with commas between them, of " + join(scene_names()))
      ->delimiter(',')
      ->capture_default_str();
  motions->add_option("--scale", what.scale, "of the scenes' numbers of fibres")
      ->capture_default_str();
  motions
      ->add_option("--ways", what.ways,
                   "of the scenes' points from frame to frame, in mean radii, with commas between "
                   "them")
      ->delimiter(',')
      ->check(finite_number(0.0))
      ->capture_default_str();
  motions->add_option(
      "--known", what.known,
      "file of motions that somebody else knows, for two parts: set,truth and 24 numbers a line");
  motions->add_flag("--json", request->json, "JSON Lines instead of tables");
}

}  // namespace fiber
