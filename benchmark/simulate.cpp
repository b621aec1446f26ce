#include "benchmark/commands.hpp"
#include "benchmark/parts.hpp"
#include "benchmark/sim/measurements.hpp"

namespace fiber {
namespace {

std::vector<MeasurementPart<SimulationMeasurement>> simulation_parts() {
  return {{"validation",
           measure_validation,
           {"test", "scene", "quantity", "segments", "theory", "simulated", "error"}},
          {"convergence",
           measure_convergence,
           {"method", "motion", "segments", "substeps", "residual", "max_iterations", "iterations",
            "error", "ms_per_step", "ms_per_second"}},
          {"contacts",
           measure_contacts,
           {"scene", "varied", "value", "quantity", "theory", "simulated", "error", "ms"}},
          {"xpbd",
           measure_xpbd,
           {"method", "motion", "segments", "inertia", "substeps", "error", "ms_per_step",
            "ms_per_second"}},
          {"peers",
           measure_peers,
           {"scene", "method", "setting", "segments", "ending", "error", "deepest", "passed",
            "ms_per_second", "times_own"}},
          {"effects",
           measure_effect_costs,
           {"added", "ms_per_step", "us_per_node_step", "bytes_per_node", "unknowns_per_node"}},
          {"real_time",
           measure_real_time,
           {"scene", "rods", "segments", "substeps", "threads", "ms_per_step", "us_per_node_step",
            "real_time_factor"}}};
}

void add_counts(CLI::App& app, const std::string& name, std::vector<int>& values,
                const std::string& meaning, std::uint64_t min = 1) {
  add_values(app, name, values, meaning + ", with commas between them", whole_number(min));
}

}  // namespace

void add_simulate_command(CLI::App& app, Command& command) {
  const auto [simulate, what] = add_parts_command<SimulationMeasurement>(
      app, command, "simulate",
      "the simulation: what theory says, error and time by segments and steps, in contact, too, "
      "beside a textbook's XPBD rod and beside Bullet and MuJoCo, what each effect costs, on one "
      "thread, in "
      "processor time; and how many times faster than the clock large scenes are",
      simulation_parts());
  add_names(*simulate, "--validations", what.validations,
            "with commas between them, of " + join(what.validations))
      ->check(CLI::IsMember(what.validations));
  add_counts(*simulate, "--segments", what.segments, "of the hose");
  add_counts(*simulate, "--substeps", what.substeps, "of a frame");
  add_values(*simulate, "--residuals", what.residuals,
             "that a step may leave [m/s], with commas between them", finite_number(1e-12));
  add_counts(*simulate, "--max-iterations", what.max_iterations, "the most of a step");
  add_counts(*simulate, "--contact-edges", what.contact_edges, "of a turn of rope around a post",
             8);
  add_counts(*simulate, "--contact-substeps", what.contact_substeps,
             "of a frame, of a rod that falls on a table");
  add_counts(*simulate, "--xpbd-segments", what.xpbd_segments, "of the XPBD hose");
  add_counts(*simulate, "--xpbd-substeps", what.xpbd_substeps, "of its frames");
  add_counts(*simulate, "--xpbd-inertias", what.xpbd_inertias,
             "of its cross-sections, times what they have");
  add_count(*simulate, "--frames", what.frames,
            "of the swinging hose; the settling one has twice as many");
  add_count(*simulate, "--reference-segments", what.reference_segments,
            "of what the hose is compared with, and half as many", 2);
  add_count(*simulate, "--reference-substeps", what.reference_substeps, "likewise", 2);
  add_value(*simulate, "--least-ms", what.min_ms, "what is faster is measured again and again",
            finite_number(0.0));
  add_counts(*simulate, "--peer-segments", what.peer_segments,
             "of a cable beside Bullet and MuJoCo");
  add_counts(*simulate, "--peer-cable-segments", what.peer_cable_segments,
             "of cables that touch, beside these");
  add_count(*simulate, "--peer-cables", what.peer_cables, "that touch, beside these");
  add_count(*simulate, "--peer-repeats", what.peer_repeats, "of each time of these");
  add_count(*simulate, "--cables", what.effects.cables, "on which effects are weighed");
  add_count(*simulate, "--cable-segments", what.effects.segments, "of each of these");
  add_count(*simulate, "--cable-frames", what.effects.frames, "to measure of these");
  add_count(*simulate, "--load-cables", what.loads.cables, "in contact, with friction");
  add_count(*simulate, "--load-rods", what.loads.rods, "without contact");
  add_count(*simulate, "--load-branches", what.loads.branches, "of a harness on an arm");
  add_count(*simulate, "--load-frames", what.loads.frames, "to time of each of these");
  add_counts(*simulate, "--load-substeps", what.loads.substeps, "of these frames");
  add_counts(*simulate, "--load-threads", what.loads.threads, "to move these with", 0);
}

}  // namespace fiber
