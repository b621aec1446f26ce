#include "src/accuracy/setting_measurement.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <random>

#include "src/accuracy/frame_order.hpp"
#include "src/accuracy/number_text.hpp"
#include "src/accuracy/resampling.hpp"
#include "src/accuracy/setting_run.hpp"
#include "src/accuracy/statistics.hpp"

namespace fiber {
namespace {

// A setting is left out that takes more than this part of the budget for one answer, and an engine
// that takes so many times as long as the reference.
constexpr double max_part_of_budget = 0.02;
constexpr double max_ratio = 20.0;

/// The part of the budget for the first answers of each setting, which are not measured.
constexpr double warm_up_part = 0.5;

/// [ms] What takes longer is asked about twice before it is measured, the rest three times.
constexpr double slow_ms = 10.0;

/// Points of all states together that points are chosen by: more take longer than they are worth.
constexpr std::size_t max_state_points = 300'000;

/// An engine, and the fibres that it is asked about. With a skin it keeps what it found for one
/// question only, so each question has its own.
struct EngineInUse {
  std::unique_ptr<ProximityEngine> engine;
  std::vector<std::uint32_t> points;    // that stay, where fibres are resampled
  std::optional<FiberAssembly> fibers;  // with these points
};

class Measurement {
 public:
  Measurement(const std::vector<FiberFrame>& frames, const std::vector<AnswerSetting>& settings,
              const TimeBudget& budget, std::size_t answers,
              const std::function<void(const std::string&)>& progress)
      : frames_(frames),
        budget_(budget),
        answers_(answers),
        progress_(progress),
        exact_(make_engine("run_tree")) {
    runs_.reserve(settings.size());
    for (const AnswerSetting& setting : settings) {
      add(setting);
    }
  }

  void run() {
    warm_up();
    bool is_first_pass = true;
    std::vector<bool> is_measured(frames_.size(), false);
    while (measure_all(is_first_pass, is_measured) && turn_ < answers_) {
      is_first_pass = false;
    }
    measured_frames_ =
        static_cast<std::size_t>(std::count(is_measured.begin(), is_measured.end(), true));
  }

  SettingMeasurement result() const {
    SettingMeasurement measurement;
    measurement.frames = measured_frames_;
    measurement.left_out = left_out_;
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      if (is_on_[i]) {
        const SettingRun& reference = runs_[reference_of_.at(runs_[i].setting().question)];
        measurement.outcomes.push_back(runs_[i].outcome(reference));
      }
    }
    return measurement;
  }

 private:
  /// Whether pairs that it finds in one frame may help in the next.
  static bool keeps_pairs(const AnswerSetting& setting) {
    return setting.engine_options.skin != 0.0;
  }

  void add(const AnswerSetting& setting) {
    std::string key = setting.engine + ' ' + std::to_string(setting.engine_options.threads) + ' ' +
                      rounded_text(setting.engine_options.skin.value_or(-1.0), 17) + ' ' +
                      rounded_text(setting.chord_error, 17);
    if (keeps_pairs(setting)) {
      key += ' ' + setting.question;
    }
    const auto [place, is_new] = place_of_.try_emplace(key, engines_.size());
    if (is_new) {
      engines_.emplace_back();
      engines_.back().engine = make_engine(setting.engine, setting.engine_options);
      if (setting.chord_error > 0.0) {
        engines_.back().points = enough_points(states(), setting.chord_error);
      }
    }
    if (setting.is_reference) {
      reference_of_[setting.question] = runs_.size();
    }
    order_.push_back(runs_.size());
    engine_of_.push_back(place->second);
    runs_.emplace_back(setting);
    is_on_.push_back(true);
  }

  /// Some frames that are spread over all.
  std::vector<const FiberAssembly*> states() const {
    std::vector<const FiberAssembly*> states;
    const std::size_t count =
        std::max<std::size_t>(1, max_state_points / frames_.front().fibers.point_count());
    const std::size_t step = (frames_.size() + count - 1) / count;
    for (std::size_t i = 0; i < frames_.size(); i += step) {
      states.push_back(&frames_[i].fibers);
    }
    return states;
  }

  /// Asks some times with each setting, the reference of a question first, and leaves out what
  /// takes too long. The first time engines are built.
  void warm_up() {
    progress_("warming up");
    const FiberAssembly& fibers = frames_.front().fibers;
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      SettingRun& run = runs_[i];
      const AnswerSetting& setting = run.setting();
      double& whole_ms = whole_ms_[setting.question];
      if (!setting.is_reference && budget_.is_used_up(warm_up_part)) {
        leave_out(i, "there was no time");
        continue;
      }
      double ms = std::numeric_limits<double>::infinity();
      const double max_ms = 1e3 * max_part_of_budget * budget_.seconds();
      for (int k = 0; k < 2 || (k < 3 && ms < slow_ms); ++k) {
        if (k == 1 && is_hopeless(setting, ms, whole_ms, max_ms)) {
          break;
        }
        EngineInUse& in_use = engines_[engine_of_[i]];
        update(in_use, fibers);
        const QueryOptions options = run.options(whole_ms);
        ms = std::min(ms, time_of([&] { in_use.engine->query(options, answer_); }));
      }
      if (setting.is_reference) {
        whole_ms = ms;
      } else if ((setting.kind == SettingKind::ENGINE && ms > max_ratio * whole_ms) ||
                 ms > max_ms) {
        leave_out(i, "an answer takes " + rounded_text(ms, 3) + " ms, with robust " +
                         rounded_text(whole_ms, 3) + " ms");
      }
    }
    warm_up_ms_ = whole_ms_;
  }

  /// Whether not even the first answer, for which engines are built, needs to be repeated.
  static bool is_hopeless(const AnswerSetting& setting, double ms, double whole_ms, double max_ms) {
    return !setting.is_reference && (ms > 10.0 * max_ms || (setting.kind == SettingKind::ENGINE &&
                                                            ms > 5.0 * max_ratio * whole_ms));
  }

  void leave_out(std::size_t run, const std::string& reason) {
    is_on_[run] = false;
    left_out_.push_back(runs_[run].setting().question + " with " + runs_[run].setting().name +
                        ": " + reason);
  }

  /// All frames once, as long as there is time.
  /// @return whether there is time for more
  bool measure_all(bool is_first_pass, std::vector<bool>& is_measured) {
    for (const FrameBlock& block : spread_blocks(frames_.size())) {
      // The frame before a block is not measured: what engines know of it helps in the next.
      for (std::size_t frame = block.begin == 0 ? 0 : block.begin - 1; frame < block.end; ++frame) {
        const bool is_counted = frame >= block.begin;
        if (turn_ > 0 && budget_.is_used_up()) {
          return false;
        }
        progress_("answer " + std::to_string(turn_ + 1) + ", frame " +
                  std::to_string(frames_[frame].frame));
        measure_frame(frame, is_counted, is_counted && !is_measured[frame]);
        is_measured[frame] = is_measured[frame] || is_counted;
      }
    }
    return is_first_pass || !budget_.is_used_up();
  }

  void measure_frame(std::size_t frame, bool is_counted, bool is_judged) {
    const FiberAssembly& fibers = frames_[frame].fibers;
    if (is_counted) {
      truths_.clear();
      exact_->update(fibers);
      set_whole_times();
    }
    shuffle(order_);
    for (const std::size_t i : order_) {
      if (is_on_[i] && (is_counted || keeps_pairs(runs_[i].setting()))) {
        ask(engines_[engine_of_[i]], runs_[i], fibers, is_counted, is_judged);
      }
    }
    turn_ += is_counted ? 1 : 0;
  }

  /// An update and a query, as a node has them, whoever shares the engine: all settings find as
  /// much in the processor's caches.
  void ask(EngineInUse& in_use, SettingRun& run, const FiberAssembly& fibers, bool is_counted,
           bool is_judged) {
    const double update_ms = update(in_use, fibers);
    const QueryOptions options = run.options(whole_ms_[run.setting().question]);
    const double query_ms = time_of([&] { in_use.engine->query(options, answer_); });
    if (!is_counted) {
      return;
    }
    run.add_time(update_ms, query_ms);
    if (is_judged || run.depends_on_time()) {
      run.judge(fibers, answer_, truth(run.setting()));
    }
  }

  /// @return [ms]
  double update(EngineInUse& in_use, const FiberAssembly& fibers) {
    if (in_use.points.empty()) {
      return time_of([&] { in_use.engine->update(fibers); });
    }
    in_use.fibers = select_points(fibers, in_use.points);
    return time_of([&] { in_use.engine->update(*in_use.fibers); });
  }

  /// Deadlines are parts of what the references take.
  void set_whole_times() {
    for (const auto& [question, run] : reference_of_) {
      whole_ms_[question] = runs_[run].has_times() ? runs_[run].query_ms() : warm_up_ms_[question];
    }
  }

  /// In another order each time, the same in every run: who goes after whom counts, as one finds in
  /// the processor's caches what the one before has used.
  void shuffle(std::vector<std::size_t>& indices) {
    for (std::size_t left = indices.size(); left > 1; --left) {
      std::swap(indices[left - 1], indices[random_() % left]);
    }
  }

  /// The exact answer to the question, once per frame.
  const QueryResult& truth(const AnswerSetting& setting) {
    const auto [place, is_new] = truths_.try_emplace(setting.question);
    if (is_new) {
      QueryOptions options = setting.options;
      options.kernel = Kernel::EXACT;
      options.tolerance = 0.0;
      options.deadline = 0.0;
      exact_->query(options, place->second);
    }
    return place->second;
  }

  const std::vector<FiberFrame>& frames_;
  const TimeBudget& budget_;
  const std::size_t answers_;  // wanted
  const std::function<void(const std::string&)>& progress_;
  const std::unique_ptr<ProximityEngine> exact_;
  std::vector<EngineInUse> engines_;
  std::map<std::string, std::size_t> place_of_;
  std::vector<SettingRun> runs_;
  std::vector<std::size_t> engine_of_;               // each run
  std::vector<bool> is_on_;                          // each run
  std::vector<std::size_t> order_;                   // of runs
  std::map<std::string, std::size_t> reference_of_;  // by question
  std::map<std::string, double> warm_up_ms_;
  std::map<std::string, double> whole_ms_;
  std::map<std::string, QueryResult> truths_;
  std::vector<std::string> left_out_;
  QueryResult answer_;
  std::mt19937 random_;
  std::size_t turn_ = 0;
  std::size_t measured_frames_ = 0;
};

}  // namespace

SettingMeasurement measure_settings(const std::vector<FiberFrame>& frames,
                                    const std::vector<AnswerSetting>& settings,
                                    const TimeBudget& budget, std::size_t answers,
                                    const std::function<void(const std::string&)>& progress) {
  Measurement measurement(frames, settings, budget, answers, progress);
  measurement.run();
  return measurement.result();
}

}  // namespace fiber
