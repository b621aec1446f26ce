#include "benchmark/measurement.hpp"

#include <cassert>
#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>

#include "benchmark/agreement.hpp"
#include "benchmark/copies.hpp"
#include "benchmark/measured_scene.hpp"
#include "benchmark/peers/peer.hpp"
#include "benchmark/swapped_places.hpp"
#include "src/accuracy/statistics.hpp"
#include "src/tools/progress.hpp"

namespace fiber {
namespace {

/// One engine and the times it has taken so far.
class EngineRun {
 public:
  EngineRun(const std::string& name, std::uint32_t threads, const FiberAssembly& fibers)
      : name_(name), engine_(make_bench_engine(name, {threads, QueryOptions().margin})) {
    engine_->update(fibers);  // builds; frames only refit
  }

  void update(const FiberAssembly& fibers) {
    update_ms_.push_back(time_of([&] { engine_->update(fibers); }));
  }

  void detect(bool closest, QueryResult& result) {
    detect_ms_.push_back(time_of([&] {
      engine_->query(QueryOptions(), result);
      // Where there are contacts, the closest pair is among them.
      if (closest && result.contacts.empty()) {
        engine_->query(closest_pair(), closest_);
      }
    }));
    cycle_ms_.push_back(update_ms_.back() + detect_ms_.back());
    constexpr double ms = 1e3;
    device_ms_.push_back(ms * engine_->facts().device_seconds);
    pairs_ = result.contacts.size();
    counts_ = result.counts;
  }

  const std::string& name() const { return name_; }

  EngineMeasurement summary() const {
    EngineMeasurement summary;
    summary.engine = name_;
    summary.threads = engine_->facts().thread_count;
    summary.update_ms = median(update_ms_);
    summary.detect_ms = median(detect_ms_);
    summary.cycle_ms = median(cycle_ms_);
    summary.device_ms = device_ms_.empty() ? 0.0 : median(device_ms_);
    summary.memory_bytes = engine_->facts().memory_bytes;
    summary.pairs = pairs_;
    summary.counts = counts_;
    return summary;
  }

 private:
  static QueryOptions closest_pair() {
    QueryOptions options;
    options.type = QueryType::CLOSEST;
    options.margin = std::numeric_limits<double>::infinity();
    return options;
  }

  std::string name_;
  std::unique_ptr<ProximityEngine> engine_;
  QueryResult closest_;
  std::size_t pairs_ = 0;
  QueryCounts counts_;
  std::vector<double> update_ms_;
  std::vector<double> detect_ms_;
  std::vector<double> cycle_ms_;
  std::vector<double> device_ms_;
};

/// Copies the points: the time below which no update that reads them all can come.
class CopyRun {
 public:
  explicit CopyRun(const FiberAssembly& fibers) : copy_(fibers.points()) {}

  void measure_frame(const FiberAssembly& fibers) {
    const std::size_t size = copy_.size() * sizeof(Eigen::Vector3d);
    memcpy_ms_.push_back(
        time_of([&] { std::memcpy(copy_.data()->data(), fibers.points().data()->data(), size); }));
    // Reading the copy keeps the compiler from leaving it out.
    if (std::memcmp(copy_.data()->data(), fibers.points().data()->data(), size) != 0) {
      throw std::logic_error("memcpy did not copy");
    }
  }

  double median_ms() const { return median(memcpy_ms_); }

 private:
  std::vector<Eigen::Vector3d> copy_;
  std::vector<double> memcpy_ms_;
};

}  // namespace

Measurement measure(const MeasurementOptions& options) {
  assert(options.repeats > 0 && !options.engines.empty());
  Progress progress;
  const Scene scene =
      side_by_side(measured_scene(options.scene, options.scene_options), options.copies);
  FiberAssembly fibers = scene(0);
  std::vector<EngineRun> runs;
  for (const std::string& name : options.engines) {
    runs.emplace_back(name, options.threads, fibers);
  }
  CopyRun copy(fibers);

  Agreement agreement;
  for (std::uint32_t frame = 1; frame <= options.repeats; ++frame) {
    const FiberAssembly moved = scene(frame);
    fibers.update_points(options.swap && frame % 2 != 0 ? swapped_places(moved) : moved.points());
    const bool detect = options.detect_every_frame || frame == options.repeats;
    const std::size_t turns = runs.size() + 1;
    agreement.begin_frame(frame);
    for (std::size_t turn = 0; turn < turns; ++turn) {
      const std::size_t whose = (frame + turn) % turns;
      if (whose == runs.size()) {
        copy.measure_frame(fibers);
        continue;
      }
      EngineRun& run = runs[whose];
      progress.show("frame " + std::to_string(frame) + " of " + std::to_string(options.repeats) +
                    ": " + run.name());
      run.update(fibers);
      if (detect) {
        run.detect(options.closest, agreement.next());
        agreement.check(run.name());
      }
    }
  }

  Measurement measurement;
  measurement.disagreement = agreement.disagreement();
  measurement.fibers = fibers.fiber_count();
  measurement.points = fibers.point_count();
  measurement.segments = fibers.segment_count();
  measurement.memcpy_ms = copy.median_ms();
  for (const EngineRun& run : runs) {
    measurement.engines.push_back(run.summary());
  }
  return measurement;
}

}  // namespace fiber
