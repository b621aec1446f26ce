#include <algorithm>
#include <iostream>
#include <limits>
#include <memory>

#include "benchmark/commands.hpp"
#include "benchmark/measured_scene.hpp"
#include "benchmark/options.hpp"
#include "benchmark/report.hpp"
#include "benchmark/scene_options.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "src/accuracy/statistics.hpp"
#include "src/paper/engines/leaf_pretest.hpp"

namespace fiber {
namespace {

struct StagesRequest {
  std::string scene = "soup";
  SceneOptions scene_options;
  std::string engine = "run_tree";
  std::uint32_t repeats = 5;
  std::uint32_t trials = 1000;
  double seconds = 10.0;
  std::string until = "detect";
  std::uint32_t threads = 0;
  bool levels = false;
  bool no_leaf_pretest = false;
};

/// Times of a call that is repeated, at least once, as often as asked for, and no longer [ms].
template <class Call>
std::vector<double> times_of(std::uint32_t repeats, double seconds, const Call& call) {
  constexpr double milli = 1e3;
  std::vector<double> times_ms;
  double spent_ms = 0.0;
  while (times_ms.size() < repeats && (times_ms.empty() || spent_ms < milli * seconds)) {
    times_ms.push_back(call());
    spent_ms += times_ms.back();
  }
  return times_ms;
}

/// One engine on one scene, stage after stage.
class Stages {
 public:
  explicit Stages(const StagesRequest& request)
      : request_(request),
        scene_(measured_scene(request.scene, request.scene_options)),
        fibers_(scene_(0)),
        engine_(make_engine(request.engine, {request.threads, 0.0})) {
    set_leaf_pretest(*engine_, !request.no_leaf_pretest);
    print("build", {{"build_ms", time_of([this] { engine_->update(fibers_); })}});
  }

  void update() {
    std::uint32_t frame = 0;
    const std::vector<double> times = times_of(request_.repeats, request_.seconds, [&] {
      fibers_.update_points(scene_(++frame).points());
      return time_of([this] { engine_->update(fibers_); });
    });
    constexpr double nano_per_milli = 1e6;
    const auto segments = static_cast<double>(fibers_.segment_count());
    const auto bytes = static_cast<double>(engine_->facts().memory_bytes);
    print("update", {{"update_ms", median(times)},
                     {"repeats", times.size()},
                     {"ns_per_segment", nano_per_milli * median(times) / segments},
                     {"bytes_per_segment", bytes / segments},
                     {"recomputed_per_segment",
                      static_cast<double>(engine_->facts().recomputed_count) / segments}});
  }

  void levels() const {
    std::vector<double> volumes;
    for (std::uint32_t level = 0; level < engine_->facts().level_count; ++level) {
      volumes.push_back(engine_->mean_level_volume(level));
    }
    print("levels", {{"mean_volumes", volumes}});
  }

  void first() {
    options_.type = QueryType::FIRST;
    const std::vector<double> times = query(request_.trials);
    print("first", {{"first_ms", mean(times)},
                    {"trials", times.size()},
                    {"pairs", result_.contacts.size()},
                    {"node_tests", result_.counts.node_tests},
                    {"primitive_tests", result_.counts.primitive_tests}});
  }

  void detect() {
    options_.type = QueryType::ALL;
    const std::vector<double> times = query(request_.repeats);
    print("detect", {{"detect_ms", median(times)},
                     {"repeats", times.size()},
                     {"pairs", result_.contacts.size()},
                     {"node_tests", result_.counts.node_tests},
                     {"node_overlaps", result_.counts.node_overlaps},
                     {"primitive_tests", result_.counts.primitive_tests}});
  }

  /// Queries whose bound shrinks with what they find.
  void closest() {
    options_.margin = std::numeric_limits<double>::infinity();
    for (const auto& [name, type] : {std::make_pair("closest", QueryType::CLOSEST),
                                     std::make_pair("limited", QueryType::LIMITED),
                                     std::make_pair("fiber_pairs", QueryType::FIBER_PAIRS)}) {
      options_.type = type;
      if (type == QueryType::FIBER_PAIRS) {
        options_.margin = 0.0;
      }
      const std::vector<double> times = query(request_.repeats);
      print(name, {{"query_ms", median(times)},
                   {"repeats", times.size()},
                   {"pairs", result_.contacts.size()},
                   {"node_tests", result_.counts.node_tests},
                   {"primitive_tests", result_.counts.primitive_tests}});
    }
  }

 private:
  std::vector<double> query(std::uint32_t repeats) {
    return times_of(repeats, request_.seconds,
                    [this] { return time_of([this] { engine_->query(options_, result_); }); });
  }

  /// A line as soon as a stage is over, so that whoever ends a run that takes too long keeps it.
  void print(const std::string& stage, const BenchmarkRow& results) const {
    BenchmarkRow line{{"stage", stage},
                      {"scene", request_.scene},
                      {"scale", request_.scene_options.scale},
                      {"seed", request_.scene_options.seed},
                      {"shuffle", request_.scene_options.shuffle},
                      {"engine", request_.engine},
                      {"threads", engine_->facts().thread_count},
                      {"fibers", fibers_.fiber_count()},
                      {"segments", fibers_.segment_count()},
                      {"leaf_pretest", !request_.no_leaf_pretest}};
    line.update(results);
    std::cout << line.dump() << std::endl;
  }

  const StagesRequest& request_;
  Scene scene_;
  FiberAssembly fibers_;
  std::unique_ptr<ProximityEngine> engine_;
  QueryOptions options_;
  QueryResult result_;
};

ExitCode run_stages(const StagesRequest& request) {
  Stages stages(request);
  stages.update();
  if (request.levels) {
    stages.levels();
  }
  if (request.until == "update") {
    return SUCCEEDED;
  }
  stages.first();
  if (request.until != "first") {
    stages.detect();
  }
  if (request.until == "closest") {
    stages.closest();
  }
  return SUCCEEDED;
}

}  // namespace

void add_stages_command(CLI::App& app, Command& command) {
  const auto request = std::make_shared<StagesRequest>();
  CLI::App* const stages = add_subcommand(
      app, command, "stages",
      "one engine on one scene: build, update, first pair, all pairs, the closest ones; a JSON "
      "line as soon as each is measured",
      request, run_stages);
  add_scene_options(*stages, request->scene, request->scene_options);
  add_value(*stages, "--engine", request->engine, "one of " + join(engine_names()));
  add_count(*stages, "--repeats", request->repeats, "of updates and of detections, at most");
  add_count(*stages, "--trials", request->trials, "of the first pair, at most");
  add_count(*stages, "--threads", request->threads,
            "most threads of the engine, 0 for as many as there are cores", 0);
  add_value(*stages, "--seconds", request->seconds, "after which no repeat or trial begins",
            CLI::Range(0.0, 1e5));
  add_value(*stages, "--until", request->until, "the last stage to measure",
            CLI::IsMember({"update", "first", "detect", "closest"}));
  stages->add_flag("--levels", request->levels, "also the mean volume of the cages of each level");
  stages->add_flag("--no-leaf-pretest", request->no_leaf_pretest,
                   "test segments without testing their own cages first");
}

}  // namespace fiber
