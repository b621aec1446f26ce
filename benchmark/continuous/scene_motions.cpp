#include "benchmark/continuous/scene_motions.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "benchmark/continuous/fiber_ways.hpp"
#include "benchmark/measured_scene.hpp"
#include "benchmark/processor_time.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "src/accuracy/statistics.hpp"
#include "src/query/contact_evaluator.hpp"

namespace fiber {
namespace {

/// [m] Of the segments.
double mean_radius(const FiberAssembly& fibers) {
  double sum = 0.0;
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    for (std::uint32_t i = fibers.offsets()[fiber]; i + 1 < fibers.offsets()[fiber + 1]; ++i) {
      sum += fibers.segment_radius(i);
    }
  }
  return sum / static_cast<double>(std::max<std::size_t>(fibers.segment_count(), 1));
}

/// A scene, and where its fibres come to.
class MovingScene {
 public:
  explicit MovingScene(const SceneMotionSettings& settings)
      : settings_(settings),
        before_(measured_scene(settings.scene, settings.scene_options)(0)),
        after_(before_),
        between_(before_),
        radius_(mean_radius(before_)) {}

  /// Has them go other ways.
  void go_on(std::uint32_t frame) {
    const std::uint64_t seed = settings_.scene_options.seed + frame;
    after_.update_points(after_own_ways(before_, settings_.way * radius_, seed));
  }

  const FiberAssembly& before() const { return before_; }
  const FiberAssembly& after() const { return after_; }
  double radius() const { return radius_; }

  /// After a part of the way; until the next call.
  const FiberAssembly& between(double part) {
    points_.resize(before_.point_count());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      points_[i] = (1.0 - part) * before_.points()[i] + part * after_.points()[i];
    }
    between_.update_points(points_);
    return between_;
  }

  /// The two segments, by their first points.
  template <class Found>
  std::uint64_t key(const Found& contact) const {
    return pair_key({before_.offsets()[contact.fiber_a] + contact.segment_a,
                     before_.offsets()[contact.fiber_b] + contact.segment_b});
  }

 private:
  const SceneMotionSettings& settings_;
  FiberAssembly before_;
  FiberAssembly after_;
  FiberAssembly between_;
  const double radius_;  // [m]
  std::vector<Eigen::Vector3d> points_;
};

/// The contacts between two frames.
struct SceneLook {
  double time_ms = 0.0;
  std::uint64_t candidates = 0;
  std::vector<std::uint64_t> found;  ///< keys of pairs, in ascending order
};

/// A way of looking.
class SceneMethod {
 public:
  virtual ~SceneMethod() = default;
  virtual std::string name() const = 0;
  virtual SceneLook look(MovingScene& scene) = 0;
  virtual std::uint32_t looks() const { return 1; }
  virtual bool finds_all() const { return true; }
};

class DiscreteLooks final : public SceneMethod {
 public:
  explicit DiscreteLooks(std::uint32_t looks) : looks_(looks) {}

  std::string name() const override { return "discrete_" + std::to_string(looks_); }
  std::uint32_t looks() const override { return looks_; }

  SceneLook look(MovingScene& scene) override {
    SceneLook look;
    for (std::uint32_t i = 1; i <= looks_; ++i) {
      const FiberAssembly& fibers =
          i == looks_ ? scene.after() : scene.between(static_cast<double>(i) / looks_);
      look.time_ms += processor_time_of([&] {
        engine_->update(fibers);
        engine_->query(QueryOptions(), result_);
      });
      look.candidates += result_.counts.primitive_tests;
      for (const Contact& contact : result_.contacts) {
        look.found.push_back(scene.key(contact));
      }
    }
    std::sort(look.found.begin(), look.found.end());
    look.found.erase(std::unique(look.found.begin(), look.found.end()), look.found.end());
    return look;
  }

 private:
  const std::uint32_t looks_;
  const std::unique_ptr<ProximityEngine> engine_ = make_engine("run_tree", {1});
  QueryResult result_;
};

class MotionLooks final : public SceneMethod {
 public:
  explicit MotionLooks(MotionType type) { options_.type = type; }

  std::string name() const override { return finds_all() ? "motion_all" : "motion_first"; }
  bool finds_all() const override { return options_.type == MotionType::ALL; }

  /// Found are contacts of different fibres, of which it is certain that they begin.
  SceneLook look(MovingScene& scene) override {
    SceneLook look;
    look.time_ms = processor_time_of([&] {
      engine_->update_motion(scene.before(), scene.after());
      engine_->query_motion(options_, result_);
    });
    look.candidates = result_.counts.primitive_tests;
    for (const MotionContact& contact : result_.contacts) {
      if (contact.certain && contact.fiber_a != contact.fiber_b) {
        look.found.push_back(scene.key(contact));
      }
    }
    return look;
  }

 private:
  MotionOptions options_;
  const std::unique_ptr<ProximityEngine> engine_ = make_engine("run_tree", {1});
  MotionResult result_;
};

/// A way of looking, and what has come out so far.
class SceneMethodRun {
 public:
  explicit SceneMethodRun(std::unique_ptr<SceneMethod> method) : method_(std::move(method)) {}

  bool takes_part(std::uint32_t frame, std::uint32_t frames) const {
    return frame < std::max(1U, frames / method_->looks());
  }

  void look(MovingScene& scene) { look_ = method_->look(scene); }
  const SceneLook& last() const { return look_; }

  /// Takes what came out last.
  void add(const SceneLook& discrete, const SceneLook& all) {
    ++result_.frames;
    result_.candidates += look_.candidates;
    times_ms_.push_back(look_.time_ms);
    ratios_.push_back(look_.time_ms / discrete.time_ms);
    result_.contacts += all.found.size();
    const auto is_missed = [&](std::uint64_t key) {
      return !std::binary_search(look_.found.begin(), look_.found.end(), key);
    };
    result_.missed +=
        static_cast<std::uint64_t>(std::count_if(all.found.begin(), all.found.end(), is_missed));
  }

  SceneMotionResult result() const {
    SceneMotionResult result = result_;
    result.method = method_->name();
    result.finds_all = method_->finds_all();
    result.time_ms = median(times_ms_);
    result.times_discrete = median(ratios_);
    return result;
  }

 private:
  std::unique_ptr<SceneMethod> method_;
  SceneLook look_;
  SceneMotionResult result_;
  std::vector<double> times_ms_;
  std::vector<double> ratios_;
};

}  // namespace

SceneMotionResults scene_motion_results(const SceneMotionSettings& settings) {
  MovingScene scene(settings);
  std::vector<SceneMethodRun> runs;
  for (const std::uint32_t looks : {1U, 10U, 100U}) {
    runs.emplace_back(std::make_unique<DiscreteLooks>(looks));
  }
  for (const MotionType type : {MotionType::ALL, MotionType::FIRST}) {
    runs.emplace_back(std::make_unique<MotionLooks>(type));
  }
  const SceneMethodRun& discrete = runs[0];
  const SceneMethodRun& all = runs[3];
  // A frame before the first has everybody find memory.
  for (std::uint32_t i = 0; i <= settings.repeats; ++i) {
    scene.go_on(i);
    const std::uint32_t frame = std::max(i, 1U) - 1;
    for (std::size_t turn = 0; turn < runs.size(); ++turn) {
      SceneMethodRun& run = runs[(i + turn) % runs.size()];
      if (run.takes_part(frame, settings.repeats)) {
        run.look(scene);
      }
    }
    for (SceneMethodRun& run : runs) {
      if (i > 0 && run.takes_part(frame, settings.repeats)) {
        run.add(discrete.last(), all.last());
      }
    }
  }
  SceneMotionResults results;
  results.segments = scene.before().segment_count();
  results.radius = scene.radius();
  for (const SceneMethodRun& run : runs) {
    results.methods.push_back(run.result());
  }
  return results;
}

}  // namespace fiber
