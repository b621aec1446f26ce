#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/agreement.hpp"
#include "benchmark/commands.hpp"
#include "benchmark/measured_scene.hpp"
#include "benchmark/options.hpp"
#include "benchmark/peers/peer.hpp"
#include "benchmark/report.hpp"
#include "benchmark/scene_options.hpp"
#include "benchmark/swaying.hpp"
#include "src/accuracy/statistics.hpp"
#include "src/query/run_tree_engine.hpp"
#include "src/tools/progress.hpp"

namespace fiber {
namespace {

struct CoherenceRequest {
  std::string scene = "soup";
  SceneOptions scene_options;
  double motion = 0.02;  // mean segment lengths per frame
  double moving = 1.0;   // part of the fibres
  std::vector<double> skins{0,    0.03, 0.06,
                            0.12, 0.24, 0.48};  // mean segment lengths, beside automatic
  std::vector<std::string> engines;             // beside run_tree, and peers
  std::uint32_t frames = 60;
  std::uint32_t threads = 1;
  bool json = false;
};

/// An engine, and the times its frames have taken.
class EngineFrames {
 public:
  /// run_tree.
  /// @param skin_lengths mean segment lengths; none: the engine chooses
  EngineFrames(const std::optional<double>& skin_lengths, double segment_length,
               std::uint32_t threads)
      : EngineFrames("run_tree", std::make_unique<RunTreeEngine>(
                                     options(skin_lengths, segment_length, threads))) {
    run_tree_ = static_cast<const RunTreeEngine*>(engine_.get());
    skin_lengths_ = skin_lengths ? BenchmarkRow(*skin_lengths) : BenchmarkRow("automatic");
  }

  EngineFrames(const std::string& engine_name, std::uint32_t threads)
      : EngineFrames(engine_name,
                     make_bench_engine(engine_name, {threads, QueryOptions().margin})) {}

  std::string name() const {
    return engine_name_ + (run_tree_ != nullptr ? " with skin " + skin_lengths_.dump() : "");
  }

  /// Updates and finds all there is, so that frames find memory and candidates.
  void warm_up(const FiberAssembly& fibers, QueryResult& result) {
    engine_->update(fibers);
    engine_->query(QueryOptions(), result);
    if (run_tree_ != nullptr) {
      refits_before_ = run_tree_->refit_count();
      partial_before_ = run_tree_->partial_count();
    }
  }

  void measure_frame(const FiberAssembly& fibers, QueryResult& result) {
    update_ms_.push_back(time_of([&] { engine_->update(fibers); }));
    detect_ms_.push_back(time_of([&] { engine_->query(QueryOptions(), result); }));
    pairs_ = result.contacts.size();
    counts_ += result.counts;
  }

  /// @param segments of the fibres
  BenchmarkRow row(double segments) const {
    BenchmarkRow row{
        {"engine", engine_name_},
        {"skin_lengths", skin_lengths_},
        {"threads", engine_->facts().thread_count},
        {"update_ms", mean(update_ms_)},
        {"detect_ms", mean(detect_ms_)},
        {"cycle_ms", mean(update_ms_) + mean(detect_ms_)},
        {"pairs", pairs_},
        {"node_tests", counts_.node_tests},
        {"node_overlaps", counts_.node_overlaps},
        {"primitive_tests", counts_.primitive_tests},
        {"bytes_per_segment", static_cast<double>(engine_->facts().memory_bytes) / segments},
        {"skin", nullptr},
        {"refits", nullptr},
        {"partial", nullptr}};
    if (run_tree_ != nullptr) {
      row["skin"] = run_tree_->skin();
      row["refits"] = run_tree_->refit_count() - refits_before_;
      row["partial"] = run_tree_->partial_count() - partial_before_;
    }
    return row;
  }

 private:
  EngineFrames(std::string engine_name, std::unique_ptr<ProximityEngine> engine)
      : engine_name_(std::move(engine_name)), engine_(std::move(engine)) {}

  static EngineOptions options(const std::optional<double>& skin_lengths, double segment_length,
                               std::uint32_t threads) {
    EngineOptions options;
    options.threads = threads;
    if (skin_lengths) {
      options.skin = *skin_lengths * segment_length;
    }
    return options;
  }

  const std::string engine_name_;
  const std::unique_ptr<ProximityEngine> engine_;
  const RunTreeEngine* run_tree_ = nullptr;  // the engine, where it has a skin to tell of
  BenchmarkRow skin_lengths_;                // mean segment lengths, "automatic", or null
  std::uint64_t refits_before_ = 0;
  std::uint64_t partial_before_ = 0;
  std::vector<double> update_ms_;
  std::vector<double> detect_ms_;
  std::size_t pairs_ = 0;
  QueryCounts counts_;  // of all frames
};

/// Frames before those that are measured: as many as the choice of a skin needs to begin with.
constexpr std::uint32_t warm_up_frames = 4;

/// A swaying scene, and on it run_tree with every skin, and the other engines.
class Coherence {
 public:
  explicit Coherence(const CoherenceRequest& request)
      : request_(request),
        scene_(measured_scene(request.scene, request.scene_options, request.motion)),
        fibers_(scene_(0)),
        segment_length_(mean_segment_length(fibers_)),
        motion_(is_scene_file(request.scene) ? motion_of(scene_) : request.motion),
        swaying_(fibers_, request.motion * segment_length_, request.scene_options.seed,
                 request.moving) {
    for (const double skin : request.skins) {
      runs_.push_back(std::make_unique<EngineFrames>(skin, segment_length_, request.threads));
    }
    runs_.push_back(std::make_unique<EngineFrames>(std::nullopt, segment_length_, request.threads));
    for (const std::string& engine : request.engines) {
      runs_.push_back(std::make_unique<EngineFrames>(engine, request.threads));
    }
  }

  /// In turns, so that what slows the machine down for a while slows all of them; who goes first
  /// changes from frame to frame.
  void measure() {
    for (std::uint32_t frame = 0; frame < warm_up_frames + request_.frames; ++frame) {
      if (is_scene_file(request_.scene)) {
        fibers_ = scene_(frame);
      } else {
        fibers_.update_points(swaying_.points(frame));
      }
      agreement_.begin_frame(frame);
      for (std::size_t turn = 0; turn < runs_.size(); ++turn) {
        EngineFrames& run = *runs_[(frame + turn) % runs_.size()];
        progress_.show("frame " + std::to_string(frame) + " of " +
                       std::to_string(warm_up_frames + request_.frames) + ": " + run.name());
        if (frame < warm_up_frames) {
          run.warm_up(fibers_, agreement_.next());
        } else {
          run.measure_frame(fibers_, agreement_.next());
        }
        agreement_.check(run.name());
      }
    }
    progress_.show("");
  }

  void print() const {
    const auto segments = static_cast<double>(fibers_.segment_count());
    if (!request_.json) {
      std::cout << request_.scene << ": " << fibers_.fiber_count() << " fibres, " << segments
                << " segments of " << segment_length_ << " m; means over " << request_.frames
                << " frame(s), the points of " << request_.moving << " of the fibres move by "
                << motion_ << " segment lengths per frame\n";
    }
    RowPrinter printer({"engine",
                        {"skin", "skin_lengths"},
                        {"skin [m]", "skin"},
                        {"update [ms]", "update_ms"},
                        {"detect [ms]", "detect_ms"},
                        {"cycle [ms]", "cycle_ms"},
                        "refits",
                        "partial",
                        "pairs"},
                       request_.json);
    for (const auto& run : runs_) {
      BenchmarkRow row{{"scene", request_.scene},
                       {"scale", request_.scene_options.scale},
                       {"seed", request_.scene_options.seed},
                       {"shuffle", request_.scene_options.shuffle},
                       {"frames", request_.frames},
                       {"motion", motion_},
                       {"moving", request_.moving},
                       {"fibers", fibers_.fiber_count()},
                       {"points", fibers_.point_count()},
                       {"segments", fibers_.segment_count()},
                       {"segment_length", segment_length_}};
      row.update(run->row(segments));
      printer.print(row);
    }
  }

  const std::string& disagreement() const { return agreement_.disagreement(); }

 private:
  const CoherenceRequest& request_;
  const Scene scene_;
  FiberAssembly fibers_;
  const double segment_length_;  // [m] mean
  const double motion_;          // mean segment lengths per frame
  Swaying swaying_;
  std::vector<std::unique_ptr<EngineFrames>> runs_;
  Agreement agreement_;
  Progress progress_;
};

ExitCode run_coherence(const CoherenceRequest& request) {
  Coherence coherence(request);
  coherence.measure();
  coherence.print();
  if (!coherence.disagreement().empty()) {
    std::cerr << "fiber_bench: " << coherence.disagreement() << '\n';
    return DISAGREED;
  }
  return SUCCEEDED;
}

}  // namespace

void add_coherence_command(CLI::App& app, Command& command) {
  const auto request = std::make_shared<CoherenceRequest>();
  CLI::App* const coherence =
      add_subcommand(app, command, "coherence",
                     "run_tree with the skin that it chooses and several others, and other "
                     "engines, on a scene that moves a little in every frame; means over the "
                     "frames, as most are cheap and those that look for candidates anew are dear",
                     request, run_coherence);
  add_scene_options(*coherence, request->scene, request->scene_options);
  add_value(*coherence, "--motion", request->motion,
            "how far points move per frame, in mean segment lengths", finite_number(0.0));
  add_value(*coherence, "--moving", request->moving, "the part of the fibres that moves",
            CLI::Range(0.0, 1.0));
  add_values(*coherence, "--skins", request->skins,
             "in mean segment lengths, with commas between them", finite_number(0.0));
  add_values(*coherence, "--engines", request->engines,
             "beside run_tree, with commas between them, of " + join(engine_names()) +
                 "; peers: " + join(all_peer_names()));
  add_count(*coherence, "--frames", request->frames, "to measure, after one to warm up");
  add_count(*coherence, "--threads", request->threads, "most threads to use");
  coherence->add_flag("--json", request->json, "JSON Lines instead of a table");
}

}  // namespace fiber
