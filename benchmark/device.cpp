#include "src/cuda/device.hpp"

#include <algorithm>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "benchmark/commands.hpp"
#include "benchmark/device_candidates.hpp"
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
  std::string device = "gpu";
  std::uint32_t threads = 1;
  std::uint32_t repeats = 11;
  bool json = false;
  bool stages = false;
  CandidateRequest candidates{0};
};

/// Times of frames [ms].
struct DeviceTimes {
  std::vector<double> over;     // points go to the GPU, and the tree is built there
  std::vector<double> to_host;  // contacts are found, and go back
  std::vector<double> all;      // both
  std::vector<double> locked;   // both, from page-locked points
  std::vector<double> copied;   // both, contacts into memory of the caller
  std::vector<double> device;   // of all this what the GPU does, where contacts stay there
  std::vector<double> run_tree;
  std::map<std::string, std::vector<double>> stages;  // of what the GPU does
  std::vector<std::string> stage_names;               // in their order
};

/// Whether contacts on the host are those of an engine, bit for bit.
template <class Arrays>
bool are_same(const Arrays& found, std::size_t count, const FiberAssembly& fibers,
              const std::vector<Contact>& contacts) {
  if (count != contacts.size()) {
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
                      {"contacts to host [ms]", "to_host_ms"},
                      {"both [ms]", "all_ms"},
                      {"page-locked points [ms]", "locked_ms"},
                      {"contacts copied [ms]", "copied_ms"},
                      "threads",
                      {"run_tree [ms]", "run_tree_ms"}},
                     request.json);
  printer.print({{"scene", request.scene},
                 {"segments", fibers.segment_count()},
                 {"contacts", contacts},
                 {"device_ms", median(times.device)},
                 {"update_ms", median(times.over)},
                 {"to_host_ms", median(times.to_host)},
                 {"all_ms", median(times.all)},
                 {"locked_ms", median(times.locked)},
                 {"copied_ms", median(times.copied)},
                 {"threads", request.threads},
                 {"run_tree_ms", median(times.run_tree)}});
}

void print_stages(const DeviceRequest& request, const DeviceTimes& times) {
  RowPrinter printer({"scene", "stage", {"on GPU [ms]", "stage_ms"}}, request.json);
  for (const std::string& stage : times.stage_names) {
    printer.print(
        {{"scene", request.scene}, {"stage", stage}, {"stage_ms", median(times.stages.at(stage))}});
  }
}

/// Adds what the last update and query took on the GPU.
void add_device_times(const DeviceProximity& device, DeviceTimes& times) {
  constexpr double ms = 1e3;
  times.device.push_back(ms * device.device_seconds());
  times.stage_names.clear();
  for (const DeviceProximity::Stage& stage : device.device_stages()) {
    times.stage_names.push_back(stage.name);
    times.stages[stage.name].push_back(ms * stage.seconds);
  }
}

ExitCode run_device(const DeviceRequest& request) {
  if (request.candidates.count > 0) {
    CandidateRequest candidates = request.candidates;
    candidates.device = request.device;
    candidates.threads = request.threads;
    candidates.repeats = request.repeats;
    candidates.json = request.json;
    return measure_candidates(candidates);
  }
  Progress progress;
  const Scene scene = measured_scene(request.scene, request.scene_options);
  FiberAssembly fibers = scene(0);
  DeviceProximity device(request.device == "host" ? make_host_device() : make_cuda_device(),
                         fibers.offsets(), fibers.radii());
  const std::unique_ptr<ProximityEngine> engine = make_engine("run_tree", {request.threads, 0.0});
  engine->update(fibers);
  QueryOptions options;
  options.neighbour_skip = 1;  // the rule of loops is the host's
  DeviceTimes times;
  DeviceProximity::Contacts arrays;
  DeviceProximity::HostContacts copies;
  QueryResult result;
  std::vector<Eigen::Vector3d> locked = fibers.points();
  const std::shared_ptr<void> lock = device.lock_points(locked);
  const auto is_same_as = [&](const auto& found, std::size_t count) {
    return are_same(found, count, fibers, result.contacts);
  };
  for (std::uint32_t frame = 0; frame <= request.repeats; ++frame) {
    progress.show("frame " + std::to_string(frame) + " of " + std::to_string(request.repeats));
    fibers.update_points(scene(frame).points());
    const double run_tree = time_of([&] {
      engine->update(fibers);
      engine->query(options, result);
    });
    const double copied = time_of([&] {
      device.update_from_host(fibers.points());
      device.copy_to_host(device.query({}), copies);
    });
    if (frame > 0) {
      add_device_times(device, times);
    }
    bool are_all_same = is_same_as(copies, copies.a.size());
    std::copy(fibers.points().begin(), fibers.points().end(), locked.begin());
    const double from_locked = time_of([&] {
      device.update_from_host(locked);
      arrays = {};  // the next take its memory
      arrays = device.query_to_host({});
    });
    are_all_same = are_all_same && is_same_as(arrays, arrays.count);
    const double over = time_of([&] { device.update_from_host(fibers.points()); });
    arrays = {};
    const double to_host = time_of([&] { arrays = device.query_to_host({}); });
    if (!are_all_same || !is_same_as(arrays, arrays.count)) {
      std::cerr << "fiber_bench: in frame " << frame << " run_tree has other contacts\n";
      return DISAGREED;
    }
    if (frame == 0) {
      continue;  // finds its memory
    }
    times.over.push_back(over);
    times.to_host.push_back(to_host);
    times.all.push_back(over + to_host);
    times.locked.push_back(from_locked);
    times.copied.push_back(copied);
    times.run_tree.push_back(run_tree);
  }
  print(request, fibers, arrays.count, times);
  if (request.stages) {
    print_stages(request, times);
  }
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
  add_value(*subcommand, "--device", request->device,
            "the GPU, or its kernels as loops on the host, to try things",
            CLI::IsMember({"gpu", "host"}));
  CandidateRequest& candidates = request->candidates;
  add_count(*subcommand, "--candidates", candidates.count,
            "in place of a scene: so many candidates of a planner, beside check_fibers()", 0);
  add_count(*subcommand, "--cables", candidates.cables, "of each candidate");
  add_count(*subcommand, "--points", candidates.points, "of each of these cables", 2);
  add_count(*subcommand, "--still", candidates.still, "cables that stand still among them", 0);
  add_value(*subcommand, "--radius", candidates.radius, "of these cables [m]", length());
  add_count(*subcommand, "--threads", request->threads, "of run_tree, or check_fibers()");
  add_count(*subcommand, "--repeats", request->repeats, "frames to measure");
  subcommand->add_flag("--stages", request->stages, "of a scene: what the GPU takes, by stages");
  subcommand->add_flag("--json", request->json, "JSON Lines instead of a table");
}

}  // namespace fiber
