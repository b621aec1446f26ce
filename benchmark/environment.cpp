#include "benchmark/commands.hpp"
#include "benchmark/environment/measurements.hpp"
#include "benchmark/parts.hpp"

namespace fiber {

void add_environment_command(CLI::App& app, Command& command) {
  const auto [environment, what] = add_parts_command<EnvironmentMeasurement>(
      app, command, "environment",
      "what the objects around cables cost: a cell with a robot, checked in every frame beside "
      "FCL; "
      "octrees of a depth camera's cloud; candidate cables, and their motions, checked in a batch",
      {{"cell",
        measure_cell,
        {"checker", "objects_ms", "cables_ms", "self_ms", "contacts_ms", "nearest_ms", "sum_ms",
         "times_own", "motion", "self_contacts", "contacts", "missed", "unwanted"}},
       {"octree", measure_octree, {"resolution", "build_ms", "cells"}},
       {"batch", measure_batch, {"threads", "per_candidate_ms", "touching"}},
       {"motions", measure_motions, {"threads", "per_candidate_ms", "touching"}}});
  add_count(*environment, "--cables", what.size.cables, "in the cell");
  add_count(*environment, "--points", what.size.points, "of each cable", 2);
  add_count(*environment, "--triangles", what.size.triangles, "of each of the eight links, about");
  add_value(*environment, "--frames-per-sway", what.size.frames_per_sway,
            "of the cables in the cell, which go up to 30 cm a sway; the arm's period is 4/3 of it",
            finite_number(1.0));
  environment->add_flag("!--without-fcl", what.beside_fcl,
                        "the cell without FCL's turns, after which nothing is in the caches");
  add_value(*environment, "--margin", what.questions.margin, "within which pairs are contacts [m]",
            finite_number(0.0));
  add_count(*environment, "--pixels", what.pixels, "of the depth camera");
  add_count(*environment, "--candidates", what.candidates, "in the batch");
  add_count(*environment, "--repeats", what.repeats, "frames of the cell, repeats of the others");
  add_count(*environment, "--threads", what.questions.threads, "most threads to use");
  add_count(*environment, "--seed", what.seed, "of the cloud and the candidates", 0);
}

}  // namespace fiber
