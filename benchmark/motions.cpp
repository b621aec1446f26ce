#include "benchmark/commands.hpp"
#include "benchmark/continuous/measurements.hpp"
#include "benchmark/parts.hpp"
#include "fiber_proximity/scenes/scene.hpp"

namespace fiber {
namespace {

/// Those in child processes come first: then no other thread has run.
std::vector<MeasurementPart<MotionMeasurement>> motion_parts() {
  return {
      {"times",
       measure_motion_times,
       {"family", "kernel", "tolerance", "misses", "start_misses", "false_alarms", "late", "early",
        "ended", "rejected_ns", "hit_ns"}},
      {"known",
       measure_known_motions,
       {"tolerance", "motions", "contacts", "contacts_missed", "contacts_invented", "near_hits"}},
      {"accuracy",
       measure_motion_accuracy,
       {"family", "tolerance", "motions", "hits", "misses", "false_alarms", "wrongly_certain",
        "wide", "without_upper", "undecided"}},
      {"scenes",
       measure_scene_motions,
       {"scene", "way", "method", "frames", "contacts", "missed", "candidates", "time_ms",
        "times_discrete"}}};
}

}  // namespace

void add_motions_command(CLI::App& app, Command& command) {
  const auto [motions, what] = add_parts_command<MotionMeasurement>(
      app, command, "motions",
      "when moving capsules first touch, on families of hard motions: our answers judged against "
      "the truth, and decisions and times of other libraries beside ours",
      motion_parts());
  add_names(*motions, "--kernels", what.kernels,
            "with commas between them, of " + join(motion_kernel_names()));
  motions->add_option("--families", what.families, "of motions, one after the other")
      ->default_str("all");
  add_value(*motions, "--seed", what.seed, "of the motions");
  add_values(*motions, "--tolerances", what.tolerances,
             "of our answers, parts of a motion's extent, with commas between them",
             finite_number(0.0));
  add_count(*motions, "--count", what.count,
            "motions to judge, per family and tolerance; a hundredth of those without thickness");
  add_count(*motions, "--threads", what.threads, "to judge with");
  add_value(*motions, "--tolerance", what.tolerance,
            "to judge other libraries by, a part of the extent", finite_number(0.0));
  add_count(*motions, "--timed", what.timed, "motions per family that all kernels are asked about");
  add_count(*motions, "--repeats", what.repeats, "of each time, of which the median counts");
  add_values(*motions, "--scenes", what.scenes,
             "with commas between them, of " + join(scene_names()));
  add_value(*motions, "--scale", what.scale, "of the scenes' numbers of fibres");
  add_values(*motions, "--ways", what.ways,
             "of the scenes' points from frame to frame, in mean radii, with commas between them",
             finite_number(0.0));
  motions->add_option(
      "--known", what.known,
      "file of motions that somebody else knows, for two parts: set,truth and 24 numbers a line");
}

}  // namespace fiber
