#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>

#include "benchmark/accuracy_settings.hpp"
#include "benchmark/commands.hpp"
#include "benchmark/measured_scene.hpp"
#include "benchmark/options.hpp"
#include "benchmark/report.hpp"
#include "benchmark/scene_options.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "src/accuracy/answer_errors.hpp"
#include "src/accuracy/statistics.hpp"
#include "src/tools/progress.hpp"

namespace fiber {
namespace {

struct AccuracyRequest {
  std::string scene = "tress_a";
  SceneOptions scene_options;
  std::string engine = "run_tree";
  std::uint32_t threads = 1;
  std::uint32_t repeats = 21;
  bool json = false;
};

/// One setting and what it has cost and brought so far.
class SettingRun {
 public:
  explicit SettingRun(const AccuracySetting& setting) : setting_(setting) {}

  /// @param whole_ms what the same query takes without a deadline
  void measure(const ProximityEngine& engine, double whole_ms, QueryResult& result) {
    QueryOptions options = setting_.options;
    deadline_ms_ = setting_.deadline_part * whole_ms;
    options.deadline = 1e-3 * deadline_ms_;
    detect_ms_.push_back(time_of([&] { engine.query(options, result); }));
    if (deadline_ms_ > 0.0) {
      late_.push_back(detect_ms_.back() / deadline_ms_ - 1.0);
    }
    pairs_ = result.contacts.size();
  }

  void judge(const AnswerErrors& errors) { errors_.add(errors); }

  const AccuracySetting& setting() const { return setting_; }
  const AnswerErrors& errors() const { return errors_; }
  double deadline_ms() const { return deadline_ms_; }
  bool has_times() const { return !detect_ms_.empty(); }
  double median_ms() const { return median(detect_ms_); }
  double p99_ms() const { return quantile(detect_ms_, 0.99); }
  /// By what part of the deadline answers were late: the 99th percentile; 0 without one.
  double late() const { return late_.empty() ? 0.0 : std::max(0.0, quantile(late_, 0.99)); }
  std::size_t pairs() const { return pairs_; }

 private:
  AccuracySetting setting_;
  std::vector<double> detect_ms_;
  std::vector<double> late_;
  AnswerErrors errors_;
  double deadline_ms_ = 0.0;
  std::size_t pairs_ = 0;
};

/// A moving scene, and one engine asked with every setting.
class Accuracy {
 public:
  explicit Accuracy(const AccuracyRequest& request)
      : request_(request),
        scene_(measured_scene(request.scene, request.scene_options)),
        fibers_(scene_(0)),
        engine_(make_engine(request.engine, {request.threads, 0.0})) {
    for (const AccuracySetting& setting : accuracy_settings(fibers_.largest_radius())) {
      runs_.emplace_back(setting);
    }
  }

  /// In turns, so that what slows the machine down for a while slows all of them; who goes first
  /// changes from frame to frame. Frame 0 warms up.
  void measure() {
    for (std::uint32_t frame = 0; frame <= request_.repeats; ++frame) {
      fibers_.update_points(scene_(frame).points());
      update_ms_.push_back(time_of([&] { engine_->update(fibers_); }));
      for (std::size_t turn = 0; turn < runs_.size(); ++turn) {
        // Without a deadline first: they tell how long the whole takes.
        SettingRun& run = runs_[frame == 0 ? turn : (frame + turn) % runs_.size()];
        progress_.show("frame " + std::to_string(frame) + " of " +
                       std::to_string(request_.repeats) + ": " + run.setting().name);
        run.measure(*engine_, whole_ms(run.setting().options.type), result_);
        run.judge(answer_errors(fibers_, run.setting().options, result_, truth(frame, run)));
      }
      if (frame == 0) {
        update_ms_.clear();
      }
    }
    progress_.show("");
  }

  void print() const {
    if (!request_.json) {
      std::cout << request_.scene << ": " << fibers_.segment_count() << " segments, "
                << request_.engine << ", median of " << request_.repeats
                << " frame(s); update takes " << median(update_ms_) << " ms\n";
    }
    RowPrinter printer({"query",
                        "setting",
                        {"detect [ms]", "detect_ms"},
                        {"p99 [ms]", "detect_p99_ms"},
                        {"late [% of the deadline]", "late", 100.0},
                        "pairs",
                        "missed",
                        "false",
                        {"found [%]", "found", 100.0},
                        {"error [m]", "error"},
                        {"bound [m]", "bound"}},
                       request_.json);
    for (const SettingRun& run : runs_) {
      const AnswerErrors& errors = run.errors();
      printer.print({{"scene", request_.scene},
                     {"scale", request_.scene_options.scale},
                     {"seed", request_.scene_options.seed},
                     {"engine", request_.engine},
                     {"segments", fibers_.segment_count()},
                     {"threads", engine_->facts().thread_count},
                     {"query", run.setting().query},
                     {"setting", run.setting().name},
                     {"kernel", name_of(run.setting().options.kernel)},
                     {"tolerance", run.setting().options.tolerance},
                     {"deadline_ms", run.deadline_ms()},
                     {"late", run.late()},
                     {"update_ms", median(update_ms_)},
                     {"detect_ms", run.median_ms()},
                     {"detect_p99_ms", run.p99_ms()},
                     {"cycle_ms", median(update_ms_) + run.median_ms()},
                     {"pairs", run.pairs()},
                     {"missed", errors.missed},
                     {"false", errors.extra},
                     {"found", errors.found_part()},
                     {"error", errors.error},
                     {"bound", errors.bound},
                     {"wrong_bounds", errors.wrong_bounds}});
    }
  }

  bool all_bounds_hold() const {
    return std::all_of(runs_.begin(), runs_.end(),
                       [](const SettingRun& run) { return run.errors().wrong_bounds == 0; });
  }

 private:
  /// The exact answer to the query of a run, once per frame and type.
  const QueryResult& truth(std::uint32_t frame, const SettingRun& run) {
    Truth& truth = truths_[static_cast<std::size_t>(run.setting().options.type)];
    if (!truth.is_there || truth.frame != frame) {
      QueryOptions options = run.setting().options;
      options.kernel = Kernel::EXACT;
      options.tolerance = 0.0;
      options.relative_tolerance = 0.0;
      engine_->query(options, truth.result);
      truth.frame = frame;
      truth.is_there = true;
    }
    return truth.result;
  }

  /// The time of a query of this type with the default kernel and no other option [ms].
  double whole_ms(QueryType type) const {
    for (const SettingRun& run : runs_) {
      if (run.setting().options.type == type && run.setting().is_reference) {
        return run.has_times() ? run.median_ms() : 0.0;
      }
    }
    return 0.0;
  }

  struct Truth {
    bool is_there = false;
    std::uint32_t frame = 0;
    QueryResult result;
  };

  const AccuracyRequest& request_;
  const Scene scene_;
  FiberAssembly fibers_;
  std::unique_ptr<ProximityEngine> engine_;
  std::vector<SettingRun> runs_;
  std::vector<double> update_ms_;
  QueryResult result_;
  Truth truths_[5];
  Progress progress_;
};

ExitCode run_accuracy(const AccuracyRequest& request) {
  Accuracy accuracy(request);
  accuracy.measure();
  accuracy.print();
  if (!accuracy.all_bounds_hold()) {
    std::cerr << "fiber_bench: an answer's bounds do not hold the exact distance\n";
    return DISAGREED;
  }
  return SUCCEEDED;
}

}  // namespace

void add_accuracy_command(CLI::App& app, Command& command) {
  const auto request = std::make_shared<AccuracyRequest>();
  CLI::App* const accuracy =
      add_subcommand(app, command, "accuracy",
                     "what kernels, tolerances and deadlines cost and bring on a moving scene",
                     request, run_accuracy);
  add_scene_options(*accuracy, request->scene, request->scene_options);
  add_value(*accuracy, "--engine", request->engine, "one of " + join(engine_names()));
  add_count(*accuracy, "--threads", request->threads, "most threads to use");
  add_count(*accuracy, "--repeats", request->repeats, "frames to measure, after one to warm up");
  accuracy->add_flag("--json", request->json, "JSON Lines instead of a table");
}

}  // namespace fiber
