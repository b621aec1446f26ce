#include <cstdint>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/query/crossings.hpp"
#include "src/io/number.hpp"
#include "src/tools/fiber_query.hpp"
#include "src/tools/text_output.hpp"

namespace fiber {
namespace {

struct TopologyRequest {
  std::string file;
  std::string format = "csv";
  ReadOptions reading;
  std::uint32_t threads = 0;
  View view;
  CurveEnds ends = CurveEnds::OPEN;

  bool json() const { return format == "json"; }
};

/// Asks of the fibres of each frame, and writes the items of the answers.
/// @param ask      of fibres
/// @param name     of the items of a frame, in JSON
/// @param to_json  makes JSON of an item, by the fibres' names
/// @param to_row   calls row(fields...) for an item, with the fields of its line of CSV
template <class Ask, class ToJson, class ToRow>
ExitCode run(const TopologyRequest& request, const std::string& columns, const char* name,
             const Ask& ask, const ToJson& to_json, const ToRow& to_row) {
  return write_frames(
      request.file, request.reading, request.json() ? "" : columns,
      [&](const FrameNumber& number, const FiberFrame& frame, TextOutput& output) {
        const auto& items = ask(frame.fibers);
        if (request.json()) {
          output.write_object(object_of(number), name, items,
                              [&](const auto& item) { return to_json(frame.names, item); });
          return;
        }
        for (const auto& item : items) {
          to_row(frame.names, item,
                 [&](const auto&... fields) { output.write_row(number, fields...); });
        }
      });
}

nlohmann::ordered_json json_of_crossing(const FiberNames& names, const Crossing& crossing) {
  return {{"fiber_a", json_of(FiberCalled{names, crossing.fiber_a})},
          {"segment_a", crossing.segment_a},
          {"s", crossing.s},
          {"fiber_b", json_of(FiberCalled{names, crossing.fiber_b})},
          {"segment_b", crossing.segment_b},
          {"t", crossing.t},
          {"over", crossing.a_is_over ? "a" : "b"},
          {"sign", crossing.sign},
          {"separation", crossing.separation},
          {"gap", crossing.gap},
          {"point_a", list_of(crossing.point_a)},
          {"point_b", list_of(crossing.point_b)}};
}

ExitCode run_crossings(const TopologyRequest& request) {
  CrossingFinder finder(request.threads);
  std::vector<Crossing> crossings;
  return run(
      request,
      "fiber_a,segment_a,s,fiber_b,segment_b,t,over,sign,separation,gap,"
      "point_a_x,point_a_y,point_a_z,point_b_x,point_b_y,point_b_z\n",
      "crossings",
      [&](const FiberAssembly& fibers) -> const std::vector<Crossing>& {
        finder.find(fibers, request.view, crossings);
        return crossings;
      },
      json_of_crossing,
      [](const FiberNames& names, const Crossing& crossing, const auto& row) {
        row(FiberCalled{names, crossing.fiber_a}, crossing.segment_a, crossing.s,
            FiberCalled{names, crossing.fiber_b}, crossing.segment_b, crossing.t,
            std::string(crossing.a_is_over ? "a" : "b"), crossing.sign, crossing.separation,
            crossing.gap, crossing.point_a, crossing.point_b);
      });
}

ExitCode run_linking(const TopologyRequest& request) {
  return run(
      request, "fiber_a,fiber_b,linking_number\n", "linking_numbers", linking_numbers,
      [](const FiberNames& names, const auto& pair) -> nlohmann::ordered_json {
        const auto& [fiber_a, fiber_b, value] = pair;
        return {{"fiber_a", json_of(FiberCalled{names, fiber_a})},
                {"fiber_b", json_of(FiberCalled{names, fiber_b})},
                {"linking_number", value}};
      },
      [](const FiberNames& names, const auto& pair, const auto& row) {
        const auto& [fiber_a, fiber_b, value] = pair;
        row(FiberCalled{names, fiber_a}, FiberCalled{names, fiber_b}, value);
      });
}

ExitCode run_writhe(const TopologyRequest& request) {
  return run(
      request, "fiber,writhe\n", "writhes",
      [&](const FiberAssembly& fibers) {
        std::vector<std::pair<std::size_t, double>> writhes;
        for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
          const auto begin = fibers.points().begin();
          writhes.emplace_back(
              fiber, writhe({begin + fibers.offsets()[fiber], begin + fibers.offsets()[fiber + 1]},
                            request.ends));
        }
        return writhes;
      },
      [](const FiberNames& names, const auto& each) -> nlohmann::ordered_json {
        return {{"fiber", json_of(FiberCalled{names, each.first})}, {"writhe", each.second}};
      },
      [](const FiberNames& names, const auto& each, const auto& row) {
        row(FiberCalled{names, each.first}, each.second);
      });
}

/// A subcommand with the options all of these have.
CLI::App* add(CLI::App& app, Command& command, const std::shared_ptr<TopologyRequest>& request,
              const char* name, const char* description,
              ExitCode (*run_it)(const TopologyRequest&)) {
  CLI::App* subcommand = app.add_subcommand(name, description);
  subcommand->add_option("FILE", request->file, file_help)->required();
  subcommand->add_option("--format", request->format, format_help)
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
  add_read_options(*crossings, request->reading);
  add_threads_option(*crossings, request->threads, threads_help);
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
