#include "src/tools/fiber_query.hpp"

#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "fiber_proximity/cuda/cuda_engines.hpp"
#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/paper/paper_engines.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "src/tools/command_line.hpp"
#include "src/tools/contact_rows.hpp"
#include "src/tools/read_input.hpp"
#include "src/tools/text_output.hpp"

namespace fiber {
namespace {

struct Request : FiberRequest {
  std::string engine = "run_tree";
  PairRequest pairs;
  Eigen::Vector3d point;  // [m]
  std::uint32_t k = 1;
  std::string format = "csv";
};

/// Asks an engine that knows the fibres of a frame.
using Ask = std::function<void(const ProximityEngine& engine, QueryResult& result)>;

void add_file_options(CLI::App& app, Request& request) {
  add_fiber_options(app, request, file_help, threads_help);
  add_engine_option(app, request.engine);
  app.add_option("--format", request.format, format_help)
      ->check(CLI::IsMember({"csv", "json"}))
      ->capture_default_str();
}

void write_json_contacts(TextOutput& output, const FrameNumber& frame, const FiberNames& names,
                         const QueryResult& result) {
  output.write_object(json_of_answer(frame, result.complete, result.minimum_lower()), "contacts",
                      result.contacts,
                      [&](const Contact& contact) { return json_of_contact(names, contact); });
}

ExitCode run(const Request& request, const Ask& ask) {
  const std::unique_ptr<ProximityEngine> engine =
      make_engine(request.engine, request.engine_options);
  const bool json = request.format == "json";
  QueryResult result;
  return write_frames(request.file, request.reading, json ? "" : contact_columns,
                      [&](const FrameNumber& number, const FiberFrame& frame, TextOutput& output) {
                        engine->update(frame.fibers);
                        ask(*engine, result);
                        if (json) {
                          write_json_contacts(output, number, frame.names, result);
                        } else {
                          write_csv_contacts(output, number, frame.names, result.contacts);
                        }
                        if (!result.complete) {
                          std::cerr << "fiber_query: " << deadline_warning(number) << '\n';
                        }
                      });
}

void add_pair_queries(CLI::App& app, Command& command, const std::shared_ptr<Request>& request) {
  for (const PairQuery& query : pair_queries()) {
    CLI::App* subcommand = app.add_subcommand(query.name, query.description);
    add_file_options(*subcommand, *request);
    add_pair_options(*subcommand, query, request->pairs);
    subcommand->callback([&command, request, query] {
      // First of all: gcc 11 loses what a closure has already taken when this throws.
      const QueryOptions options = options_of(query, request->pairs);
      command = [request, options] {
        return run(*request, [&options](const ProximityEngine& engine, QueryResult& result) {
          engine.query(options, result);
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
  const std::vector<std::string> own_engines = engine_names();
  register_paper_engines();
  register_cuda_engines();
  app.require_subcommand(0, 1);
  const auto request = std::make_shared<Request>();
  add_pair_queries(app, command, request);
  add_nearest(app, command, request);
  add_segments(app, command);
  add_motions(app, command);
  add_sweep(app, command);
  add_check(app, command);
  add_compare(app, command);
  add_topology(app, command);
  add_accuracy(app, command, own_engines);
}

}  // namespace

void add_engine_option(CLI::App& app, std::string& engine) {
  app.add_option("--engine", engine, "one of " + join(engine_names()))->capture_default_str();
}

ExitCode write_frames(const std::string& path, const ReadOptions& reading,
                      const std::string& columns,
                      const std::function<void(const FrameNumber& number, const FiberFrame& frame,
                                               TextOutput& output)>& write) {
  const FiberFile file = read_input("fiber_query", path, reading);
  TextOutput output(std::cout);
  if (!columns.empty()) {
    output.write((file.has_frames ? "frame," : "") + columns);
  }
  for (const FiberFrame& frame : file.frames) {
    write({file.has_frames, frame.frame}, frame, output);
    output.flush();
  }
  output.flush();  // the header of a file without frames
  return SUCCEEDED;
}

}  // namespace fiber

int main(int argc, char** argv) {
  return fiber::run_tool("fiber_query", "Contacts, distances and crossings of the fibres in a file",
                         fiber::setup, argc, argv);
}
