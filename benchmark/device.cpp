#include <algorithm>
#include <iostream>
#include <memory>

#include "benchmark/commands.hpp"
#include "benchmark/measured_scene.hpp"
#include "benchmark/measurement.hpp"
#include "benchmark/options.hpp"
#include "benchmark/report.hpp"
#include "benchmark/scene_options.hpp"
#include "fiber_proximity/cuda/device_proximity.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "src/accuracy/statistics.hpp"
#include "src/tools/progress.hpp"

namespace fiber {
namespace {

struct DeviceRequest {
  std::string scene = "soup";
  SceneOptions scene_options;
  std::uint32_t threads = 1;
  std::uint32_t repeats = 11;
  bool json = false;
};

/// Times of frames [ms].
struct DeviceTimes {
  std::vector<double> over;    // points go to the GPU, and the tree is built there
  std::vector<double> query;   // contacts are found
  std::vector<double> back;    // contacts go back
  std::vector<double> all;     // the three
  std::vector<double> device;  // of all this what the GPU does
  std::vector<double> run_tree;
};

/// Whether contacts on the host are those of an engine, bit for bit.
bool are_same(const DeviceProximity::HostContacts& found, const FiberAssembly& fibers,
              const std::vector<Contact>& contacts) {
  if (found.a.size() != contacts.size()) {
    return false;
  }
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    if (found.a[i] != fibers.offsets()[contact.fiber_a] + contact.segment_a ||
        found.b[i] != fibers.offsets()[contact.fiber_b] + contact.segment_b ||
        found.s[i] != contact.s || found.t[i] != contact.t ||
        found.distance[i] != contact.distance) {
      return false;
    }
  }
  return true;
}

void print(const DeviceRequest& request, const FiberAssembly& fibers, std::size_t contacts,
           const DeviceTimes& times) {
  RowPrinter printer({"scene",
                      "segments",
                      "contacts",
                      {"on GPU [ms]", "device_ms"},
                      {"points over, tree [ms]", "update_ms"},
                      {"query [ms]", "query_ms"},
                      {"contacts back [ms]", "back_ms"},
                      {"all [ms]", "all_ms"},
                      "threads",
                      {"run_tree [ms]", "run_tree_ms"}},
                     request.json);
  printer.print({{"scene", request.scene},
                 {"segments", fibers.segment_count()},
                 {"contacts", contacts},
                 {"device_ms", median(times.device)},
                 {"update_ms", median(times.over)},
                 {"query_ms", median(times.query)},
                 {"back_ms", median(times.back)},
                 {"all_ms", median(times.all)},
                 {"threads", request.threads},
                 {"run_tree_ms", median(times.run_tree)}});
}

ExitCode run_device(const DeviceRequest& request) {
  Progress progress;
  const Scene scene = measured_scene(request.scene, request.scene_options);
  FiberAssembly fibers = scene(0);
  DeviceProximity device(fibers.offsets(), fibers.radii());
  const std::unique_ptr<ProximityEngine> engine = make_engine("run_tree", {request.threads, 0.0});
  engine->update(fibers);
  QueryOptions options;
  options.neighbour_skip = 1;  // the rule of loops is the host's
  DeviceTimes times;
  DeviceProximity::HostContacts contacts;
  QueryResult result;
  for (std::uint32_t frame = 0; frame <= request.repeats; ++frame) {
    progress.show("frame " + std::to_string(frame) + " of " + std::to_string(request.repeats));
    fibers.update_points(scene(frame).points());
    DeviceProximity::Contacts found;
    const double over = time_of([&] { device.update_from_host(fibers.points()); });
    const double query = time_of([&] { found = device.query({}); });
    const double back = time_of([&] { device.copy_to_host(found, contacts); });
    const double run_tree = time_of([&] {
      engine->update(fibers);
      engine->query(options, result);
    });
    if (!are_same(contacts, fibers, result.contacts)) {
      std::cerr << "fiber_bench: in frame " << frame << " run_tree has other contacts\n";
      return DISAGREED;
    }
    if (frame == 0) {
      continue;  // finds its memory
    }
    constexpr double ms = 1e3;
    times.over.push_back(over);
    times.query.push_back(query);
    times.back.push_back(back);
    times.all.push_back(over + query + back);
    times.device.push_back(ms * device.device_seconds());
    times.run_tree.push_back(run_tree);
  }
  print(request, fibers, contacts.a.size(), times);
  return SUCCEEDED;
}

}  // namespace

void add_device_command(CLI::App& app, Command& command) {
  const auto request = std::make_shared<DeviceRequest>();
  CLI::App* const subcommand = add_subcommand(
      app, command, "device",
      "contacts that stay on a GPU, or go back as arrays, beside run_tree for the same", request,
      run_device);
  add_scene_options(*subcommand, request->scene, request->scene_options);
  add_count(*subcommand, "--threads", request->threads, "of run_tree");
  add_count(*subcommand, "--repeats", request->repeats, "frames to measure");
  subcommand->add_flag("--json", request->json, "JSON Lines instead of a table");
}

}  // namespace fiber
