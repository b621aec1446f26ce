#include "src/tools/topology_commands.hpp"

#include <cstdint>
#include <functional>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/query/crossings.hpp"
#include "fiber_proximity/query/topology.hpp"
#include "src/io/number.hpp"
#include "src/tools/crossing_format.hpp"
#include "src/tools/text_output.hpp"

namespace fiber {
namespace {

using Frame = std::optional<std::int64_t>;

struct TopologyRequest {
  std::string file;
  std::string format = "csv";
  double radius = 0.0;  // [m]
  std::uint32_t threads = 0;
  View view;
  CurveEnds ends = CurveEnds::OPEN;

  bool json() const { return format == "json"; }
};

/// Writes the answer for the fibres of a frame.
using Answer = std::function<void(const FiberAssembly& fibers, Frame frame, TextOutput& output)>;

ExitCode run(const TopologyRequest& request, const std::string& columns, const Answer& answer) {
  const FiberFile file = read_fibers(request.file, request.radius);
  TextOutput output(std::cout);
  output.text() = request.json() ? "" : (file.has_frames ? "frame," : "") + columns;
  for (const FiberFrame& frame : file.frames) {
    answer(frame.fibers, file.has_frames ? Frame(frame.frame) : std::nullopt, output);
    output.flush();
  }
  output.flush();  // the header of a file without frames
  return SUCCEEDED;
}

ExitCode run_crossings(const TopologyRequest& request) {
  CrossingFinder finder(request.threads);
  std::vector<Crossing> crossings;
  return run(request, crossings_csv_header(),
             [&](const FiberAssembly& fibers, Frame frame, TextOutput& output) {
               finder.find(fibers, request.view, crossings);
               request.json() ? write_json(output, frame, crossings)
                              : write_csv(output, frame, crossings);
             });
}

/// Writes fields, with commas between them, as a line.
template <class... Fields>
void write_line(TextOutput& output, Frame frame, const Fields&... fields) {
  std::string& text = output.text();
  if (frame) {
    append_number(text, *frame);
    text += ',';
  }
  (
      [&text](const auto& field) {
        append_number(text, field);
        text += ',';
      }(fields),
      ...);
  text.back() = '\n';
  output.flush_if_long();
}

void write_object(TextOutput& output, Frame frame, const char* name, nlohmann::ordered_json list) {
  nlohmann::ordered_json object;
  if (frame) {
    object["frame"] = *frame;
  }
  object[name] = std::move(list);
  output.text() += object.dump();
  output.text() += '\n';
}

ExitCode run_linking(const TopologyRequest& request) {
  return run(
      request, "fiber_a,fiber_b,linking_number\n",
      [&](const FiberAssembly& fibers, Frame frame, TextOutput& output) {
        auto list = nlohmann::ordered_json::array();
        for (const auto& [fiber_a, fiber_b, value] : linking_numbers(fibers)) {
          if (request.json()) {
            list.push_back({{"fiber_a", fiber_a}, {"fiber_b", fiber_b}, {"linking_number", value}});
          } else {
            write_line(output, frame, fiber_a, fiber_b, value);
          }
        }
        if (request.json()) {
          write_object(output, frame, "linking_numbers", std::move(list));
        }
      });
}

ExitCode run_writhe(const TopologyRequest& request) {
  return run(
      request, "fiber,writhe\n", [&](const FiberAssembly& fibers, Frame frame, TextOutput& output) {
        auto list = nlohmann::ordered_json::array();
        for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
          const auto begin = fibers.points().begin();
          const double value = writhe(
              {begin + fibers.offsets()[fiber], begin + fibers.offsets()[fiber + 1]}, request.ends);
          if (request.json()) {
            list.push_back({{"fiber", fiber}, {"writhe", value}});
          } else {
            write_line(output, frame, fiber, value);
          }
        }
        if (request.json()) {
          write_object(output, frame, "writhes", std::move(list));
        }
      });
}

/// A subcommand with the options all of these have.
CLI::App* add(CLI::App& app, Command& command, const std::shared_ptr<TopologyRequest>& request,
              const char* name, const char* description,
              ExitCode (*run_it)(const TopologyRequest&)) {
  CLI::App* subcommand = app.add_subcommand(name, description);
  subcommand->add_option("FILE", request->file, "fibre file (.csv or .hair)")->required();
  subcommand->add_option("--format", request->format, "of the output; json: one object per frame")
      ->check(CLI::IsMember({"csv", "json"}))
      ->capture_default_str();
  subcommand->callback(
      [&command, request, run_it] { command = [request, run_it] { return run_it(*request); }; });
  return subcommand;
}

void add_view_options(CLI::App& crossings, const std::shared_ptr<TopologyRequest>& request) {
  crossings
      .add_option_function<std::string>(
          "--direction",
          [request](const std::string& text) {
            request->view.direction = parse_vector("--direction", text);
            validate(request->view);
          },
          "X,Y,Z along which the viewer looks")
      ->default_str("0,0,-1");
  crossings.add_option_function<std::string>(
      "--eye",
      [request](const std::string& text) {
        request->view.eye = parse_vector("--eye", text);
        request->view.is_perspective = true;
      },
      "X,Y,Z of the viewer, who sees what is in front of it [m]; without, all rays of sight are "
      "parallel");
}

}  // namespace

void add_topology(CLI::App& app, Command& command) {
  const auto request = std::make_shared<TopologyRequest>();
  CLI::App* crossings =
      add(app, command, request, "crossings",
          "where fibres cross over and under each other and themselves in a view", run_crossings);
  add_view_options(*crossings, request);
  crossings->add_option("--radius", request->radius, "of all fibres, if the file has no radii [m]")
      ->capture_default_str();
  crossings
      ->add_option("--threads", request->threads,
                   "most threads to use, 0 for as many as there are cores")
      ->check(whole_number(0))
      ->capture_default_str();
  add(app, command, request, "linking",
      "linking numbers of the fibres, each closed from its last point to its first; pairs that are "
      "not listed have 0",
      run_linking);
  CLI::App* writhes =
      add(app, command, request, "writhe",
          "of each fibre: the mean sum of its crossings' signs over all views", run_writhe);
  writhes->add_flag_callback(
      "--closed", [request] { request->ends = CurveEnds::CLOSED; },
      "each fibre's last point is joined to its first");
}

}  // namespace fiber
