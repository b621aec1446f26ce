#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "benchmark/commands.hpp"
#include "benchmark/measurement.hpp"
#include "benchmark/peers/peer.hpp"
#include "benchmark/scene_options.hpp"
#include "fiber_proximity/query/engine.hpp"

namespace fiber {
namespace {

struct SceneCommandsRequest {
  MeasurementOptions options;
  bool json = false;
};

void print_measurement_json(const MeasurementOptions& options, const Measurement& measurement) {
  for (const EngineMeasurement& engine : measurement.engines) {
    const nlohmann::ordered_json line{
        {"scene", options.scene},
        {"scale", options.scene_options.scale},
        {"seed", options.scene_options.seed},
        {"shuffle", options.scene_options.shuffle},
        {"copies", options.copies},
        {"repeats", options.repeats},
        {"swap", options.swap},
        {"engine", engine.engine},
        {"fibers", measurement.fibers},
        {"points", measurement.points},
        {"segments", measurement.segments},
        {"threads", engine.threads},
        {"update_ms", engine.update_ms},
        {"detect_ms", engine.detect_ms},
        {"cycle_ms", engine.cycle_ms},
        {"pairs", engine.pairs},
        {"node_tests", engine.counts.node_tests},
        {"node_overlaps", engine.counts.node_overlaps},
        {"primitive_tests", engine.counts.primitive_tests},
        {"bytes_per_segment",
         static_cast<double>(engine.memory_bytes) / static_cast<double>(measurement.segments)},
        {"memcpy_ms", measurement.memcpy_ms},
        {"update_per_memcpy", engine.update_ms / measurement.memcpy_ms}};
    std::cout << line.dump() << '\n';
  }
}

void print_measurement_table(const MeasurementOptions& options, const Measurement& measurement) {
  std::cout << options.scene << ": " << measurement.fibers << " fibres, " << measurement.segments
            << " segments; median of " << options.repeats << " frame(s); memcpy of the points "
            << std::fixed << std::setprecision(3) << measurement.memcpy_ms << " ms\n";
  constexpr int name_width = 14;
  constexpr int width = 16;
  std::cout << std::left << std::setw(name_width) << "engine" << std::right;
  for (const char* column : {"update [ms]", "detect [ms]", "cycle [ms]", "update/memcpy", "pairs",
                             "node tests", "overlaps", "primitive tests"}) {
    std::cout << std::setw(width) << column;
  }
  std::cout << '\n';
  for (const EngineMeasurement& engine : measurement.engines) {
    std::cout << std::left << std::setw(name_width) << engine.engine << std::right;
    for (const double value : {engine.update_ms, engine.detect_ms, engine.cycle_ms,
                               engine.update_ms / measurement.memcpy_ms}) {
      std::cout << std::setw(width) << value;
    }
    for (const std::uint64_t count : {std::uint64_t{engine.pairs}, engine.counts.node_tests,
                                      engine.counts.node_overlaps, engine.counts.primitive_tests}) {
      std::cout << std::setw(width) << count;
    }
    std::cout << '\n';
  }
}

ExitCode run(const SceneCommandsRequest& request) {
  const Measurement measurement = measure(request.options);
  (request.json ? print_measurement_json : print_measurement_table)(request.options, measurement);
  if (!measurement.disagreement.empty()) {
    std::cerr << "fiber_bench: " << measurement.disagreement << '\n';
    return DISAGREED;
  }
  return SUCCEEDED;
}

void add(CLI::App& app, Command& command, const std::string& name, const std::string& description,
         std::uint32_t repeats, bool detect_every_frame) {
  const auto request = std::make_shared<SceneCommandsRequest>();
  MeasurementOptions& options = request->options;
  options.repeats = repeats;
  options.detect_every_frame = detect_every_frame;
  CLI::App* subcommand = app.add_subcommand(name, description);
  subcommand->callback([&command, request] { command = [request] { return run(*request); }; });
  add_scene_options(*subcommand, options.scene, options.scene_options);
  subcommand->add_option("--copies", options.copies, "of the scene, side by side")
      ->check(whole_number(1))
      ->capture_default_str();
  subcommand
      ->add_option("--engines", options.engines,
                   "with commas between them, of " + join(engine_names()) +
                       "; peers: " + join(all_peer_names()))
      ->delimiter(',')
      ->capture_default_str();
  subcommand
      ->add_option("--threads", options.threads,
                   "most threads to use; only run_tree and the peers cgal and embree use several")
      ->check(whole_number(1))
      ->capture_default_str();
  subcommand->add_option("--repeats", options.repeats, "frames to measure")
      ->check(whole_number(1))
      ->capture_default_str();
  subcommand->add_flag("--swap", options.swap,
                       "in every other frame fibres stand where others stood, so that an order in "
                       "space has to be made anew in every frame");
  subcommand->add_flag(
      "--closest", options.closest,
      "find the closest pair even if there is no contact, as the node does; not peers");
  subcommand->add_flag("--json", request->json, "JSON Lines instead of a table");
}

}  // namespace

void add_scene_commands(CLI::App& app, Command& command) {
  add(app, command, "update", "update engines on every frame of a scene, detect pairs on the last",
      21, false);
  add(app, command, "cycle", "update engines and detect all pairs on every frame of a scene", 3,
      true);
}

}  // namespace fiber
