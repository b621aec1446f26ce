#include "src/tools/fiber_query.hpp"

#include <cmath>
#include <functional>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "src/tools/command_line.hpp"
#include "src/tools/contact_rows.hpp"
#include "src/tools/text_output.hpp"

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

nlohmann::ordered_json json_of_contact(const Contact& contact) {
  return {{"fiber_a", contact.fiber_a},
          {"segment_a", contact.segment_a},
          {"s", contact.s},
          {"fiber_b", contact.fiber_b},
          {"segment_b", contact.segment_b},
          {"t", contact.t},
          {"distance", contact.distance},
          {"lower", contact.lower},
          {"upper", contact.upper},
          {"point_a", list_of(contact.point_a)},
          {"point_b", list_of(contact.point_b)},
          {"normal", list_of(contact.normal)}};
}

/// A line with one JSON object: the frame's number, if it has one, whether the answer is complete,
/// what no pair is closer than (null without a pair), and the contacts.
void write_json_contacts(TextOutput& output, const FrameNumber& frame, const QueryResult& result) {
  nlohmann::ordered_json object = object_of(frame);
  object["complete"] = result.complete;
  const double lower = result.minimum_lower();
  object["minimum_lower"] = std::isfinite(lower) ? nlohmann::ordered_json(lower) : nullptr;
  output.write_object(std::move(object), "contacts", result.contacts, json_of_contact);
}

ExitCode run(const Request& request, const Ask& ask) {
  const std::unique_ptr<ProximityEngine> engine =
      make_engine(request.engine, request.engine_options);
  const FiberFile file = read_fibers(request.file, request.radius);
  const bool json = request.format == "json";
  QueryResult result;
  TextOutput output(std::cout);
  if (!json) {
    output.write((file.has_frames ? "frame," : "") + std::string(contact_columns));
  }
  for (const FiberFrame& frame : file.frames) {
    engine->update(frame.fibers);
    ask(*engine, result);
    const FrameNumber number{file.has_frames, frame.frame};
    if (json) {
      write_json_contacts(output, number, result);
    } else {
      write_csv_contacts(output, number, result.contacts);
    }
    output.flush();
    if (!result.complete) {
      std::cerr << "fiber_query: the deadline has passed"
                << (number.is_given ? " in frame " + std::to_string(number.number) : "")
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

void add_fiber_options(CLI::App& app, FiberRequest& request, const std::string& threads) {
  app.add_option("FILE", request.file, "fibre file (.csv or .hair)")->required();
  app.add_option("--engine", request.engine, "one of " + join(engine_names()))
      ->capture_default_str();
  app.add_option("--radius", request.radius, "of all fibres, if the file has no radii [m]")
      ->capture_default_str();
  app.add_option("--threads", request.engine_options.threads, threads)
      ->check(whole_number(0))
      ->capture_default_str();
}

}  // namespace fiber

int main(int argc, char** argv) {
  return fiber::run_tool("fiber_query", "Contacts, distances and crossings of the fibres in a file",
                         fiber::setup, argc, argv);
}
