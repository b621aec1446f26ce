#include <functional>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "src/tools/command_line.hpp"
#include "src/tools/compare_command.hpp"
#include "src/tools/contact_format.hpp"
#include "src/tools/fiber_options.hpp"
#include "src/tools/motions_command.hpp"
#include "src/tools/segments_command.hpp"
#include "src/tools/sweep_command.hpp"
#include "src/tools/topology_commands.hpp"

namespace fiber {
namespace {

struct Request : FiberRequest {
  QueryOptions query;
  std::optional<double> margin;  // [m]
  Eigen::Vector3d point;         // [m]
  std::uint32_t k = 1;
  std::string format = "csv";
};

struct Query {
  const char* name;
  const char* description;
  QueryType type;
  double default_margin;  // [m]
};

/// Asks an engine that knows the fibres of a frame.
using Ask = std::function<void(const ProximityEngine& engine, QueryResult& result)>;

void add_file_options(CLI::App& app, Request& request) {
  add_fiber_options(app, request);
  app.add_option("--format", request.format, "of the output; json: one object per frame")
      ->check(CLI::IsMember({"csv", "json"}))
      ->capture_default_str();
}

void add_accuracy_options(CLI::App& app, Request& request) {
  add_kernel_option(app, request.query.kernel);
  app.add_option("--tolerance", request.query.tolerance,
                 "the closest pairs may be missed by less than this [m]")
      ->capture_default_str();
  app.add_option("--relative-tolerance", request.query.relative_tolerance,
                 "the same as a part of the distance")
      ->capture_default_str();
  app.add_option("--deadline", request.query.deadline,
                 "time to answer a frame [s]; what is found by then is the answer; 0 for none")
      ->capture_default_str();
}

void add_pair_options(CLI::App& app, const Query& query, Request& request) {
  app.add_option("--margin", request.margin,
                 "pairs with a gap of at most this [m]; inf for no limit")
      ->default_str(query.default_margin == 0.0 ? "0" : "inf");
  add_neighbour_options(app, request.query.neighbour_skip, request.query.neighbour_skip_length);
}

ExitCode run(const Request& request, const Ask& ask) {
  const std::unique_ptr<ProximityEngine> engine =
      make_engine(request.engine, request.engine_options);
  const FiberFile file = read_fibers(request.file, request.radius);
  const bool json = request.format == "json";
  QueryResult result;
  TextOutput output(std::cout);
  output.text() = json ? "" : csv_header(file.has_frames);
  for (const FiberFrame& frame : file.frames) {
    engine->update(frame.fibers);
    ask(*engine, result);
    const std::optional<std::int64_t> number =
        file.has_frames ? std::optional(frame.frame) : std::nullopt;
    if (json) {
      write_json(output, number, result);
    } else {
      write_csv(output, number, result.contacts);
    }
    output.flush();
    if (!result.complete) {
      std::cerr << "fiber_query: the deadline has passed"
                << (number ? " in frame " + std::to_string(*number) : "")
                << ": pairs may be missing\n";
    }
  }
  output.flush();  // the header of a file without frames
  return SUCCEEDED;
}

void add_pair_queries(CLI::App& app, Command& command, const std::shared_ptr<Request>& request) {
  const double infinity = std::numeric_limits<double>::infinity();
  const Query queries[] = {
      {"contacts", "all pairs of segments within the margin", QueryType::ALL, 0.0},
      {"closest", "the closest pair", QueryType::CLOSEST, infinity},
      {"first", "any one pair within the margin", QueryType::FIRST, 0.0},
      {"fiber_pairs", "the closest pair of each pair of fibres, of a fibre with itself too",
       QueryType::FIBER_PAIRS, infinity}};
  for (const Query& query : queries) {
    CLI::App* subcommand = app.add_subcommand(query.name, query.description);
    add_file_options(*subcommand, *request);
    add_pair_options(*subcommand, query, *request);
    add_accuracy_options(*subcommand, *request);
    subcommand->callback([&command, request, query] {
      request->query.type = query.type;
      request->query.margin = request->margin.value_or(query.default_margin);
      validate(request->query);
      command = [request] {
        return run(*request, [request](const ProximityEngine& engine, QueryResult& result) {
          engine.query(request->query, result);
        });
      };
    });
  }
}

void add_nearest(CLI::App& app, Command& command, const std::shared_ptr<Request>& request) {
  CLI::App* nearest = app.add_subcommand(
      "nearest", "the segments nearest to a point, nearest first; in the output b is the segment");
  add_file_options(*nearest, *request);
  nearest
      ->add_option_function<std::string>(
          "--point",
          [request](const std::string& text) { request->point = parse_vector("--point", text); },
          "X,Y,Z [m]")
      ->required();
  nearest->add_option("--k", request->k, "how many segments")
      ->check(whole_number(1))
      ->capture_default_str();
  nearest->callback([&command, request] {
    command = [request] {
      return run(*request, [request](const ProximityEngine& engine, QueryResult& result) {
        nearest_segments(engine, request->point, request->k, result);
      });
    };
  });
}

void setup(CLI::App& app, Command& command) {
  app.require_subcommand(0, 1);
  const auto request = std::make_shared<Request>();
  add_pair_queries(app, command, request);
  add_nearest(app, command, request);
  add_segments(app, command);
  add_motions(app, command);
  add_sweep(app, command);
  add_compare(app, command);
  add_topology(app, command);
}

}  // namespace
}  // namespace fiber

int main(int argc, char** argv) {
  return fiber::run_tool("fiber_query", "Contacts, distances and crossings of the fibres in a file",
                         fiber::setup, argc, argv);
}
