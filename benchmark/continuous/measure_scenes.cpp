#include "benchmark/continuous/measurements.hpp"
#include "benchmark/continuous/scene_motions.hpp"

namespace fiber {

void measure_scene_motions(const MotionMeasurement& what, const ReportRow& report) {
  for (const std::string& scene : what.scenes) {
    for (const double way : what.ways) {
      SceneMotionSettings settings;
      settings.scene = scene;
      settings.scene_options.scale = what.scale;
      settings.scene_options.seed = what.seed;
      settings.way = way;
      settings.repeats = what.repeats;
      const SceneMotionResults results = scene_motion_results(settings);
      for (const SceneMotionResult& result : results.methods) {
        const bool is_judged = result.finds_all;
        report({{"scene", scene},
                {"scale", what.scale},
                {"seed", what.seed},
                {"segments", results.segments},
                {"radius", results.radius},
                {"way", way},
                {"method", result.method},
                {"frames", result.frames},
                {"contacts", result.contacts},
                {"missed", is_judged ? BenchmarkRow(result.missed) : BenchmarkRow()},
                {"candidates", result.candidates},
                {"time_ms", result.time_ms},
                {"times_discrete", result.times_discrete}});
      }
    }
  }
}

}  // namespace fiber
