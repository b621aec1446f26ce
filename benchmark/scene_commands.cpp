#include <iostream>
#include <memory>

#include "benchmark/commands.hpp"
#include "benchmark/measurement.hpp"
#include "benchmark/options.hpp"
#include "benchmark/peers/peer.hpp"
#include "benchmark/report.hpp"
#include "benchmark/scene_options.hpp"
#include "fiber_proximity/query/engine.hpp"

namespace fiber {
namespace {

struct SceneCommandsRequest {
  MeasurementOptions options;
  bool json = false;
};

void print(const Measurement& measurement, const MeasurementOptions& options, bool json) {
  if (!json) {
    std::cout << options.scene << ": " << measurement.fibers << " fibres, " << measurement.segments
              << " segments; median of " << options.repeats << " frame(s); memcpy of the points "
              << measurement.memcpy_ms << " ms\n";
  }
  RowPrinter printer({"engine",
                      {"update [ms]", "update_ms"},
                      {"detect [ms]", "detect_ms"},
                      {"cycle [ms]", "cycle_ms"},
                      {"on GPU [ms]", "device_ms"},
                      {"update/memcpy", "update_per_memcpy"},
                      "pairs",
                      {"node tests", "node_tests"},
                      {"overlaps", "node_overlaps"},
                      {"primitive tests", "primitive_tests"}},
                     json);
  for (const EngineMeasurement& engine : measurement.engines) {
    printer.print({{"scene", options.scene},
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
                   {"device_ms", engine.device_ms},
                   {"pairs", engine.pairs},
                   {"node_tests", engine.counts.node_tests},
                   {"node_overlaps", engine.counts.node_overlaps},
                   {"primitive_tests", engine.counts.primitive_tests},
                   {"bytes_per_segment", static_cast<double>(engine.memory_bytes) /
                                             static_cast<double>(measurement.segments)},
                   {"memcpy_ms", measurement.memcpy_ms},
                   {"update_per_memcpy", engine.update_ms / measurement.memcpy_ms}});
  }
}

ExitCode run_engines(const SceneCommandsRequest& request) {
  const Measurement measurement = measure(request.options);
  print(measurement, request.options, request.json);
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
  CLI::App* const subcommand =
      add_subcommand(app, command, name, description, request, run_engines);
  add_scene_options(*subcommand, options.scene, options.scene_options);
  add_count(*subcommand, "--copies", options.copies, "of the scene, side by side");
  add_values(*subcommand, "--engines", options.engines,
             "with commas between them, of " + join(engine_names()) +
                 "; peers: " + join(all_peer_names()));
  add_count(*subcommand, "--threads", options.threads,
            "most threads to use; only run_tree and the peers cgal and embree use several");
  add_count(*subcommand, "--repeats", options.repeats, "frames to measure");
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
