#include "benchmark/sim/loads.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

#include "benchmark/sim/effect_scene.hpp"
#include "fiber_proximity/environment/scene/environment_scene.hpp"
#include "fiber_proximity/sim/attachment.hpp"
#include "fiber_proximity/sim/scene/prediction.hpp"
#include "src/accuracy/statistics.hpp"
#include "validation/sim/contact_scenes.hpp"
#include "validation/sim/harness_scene.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

constexpr double frame_time = 1.0 / 60.0;  // [s]

/// Rods in rows, held at their upper ends, that begin level and so swing.
Stepper swinging_rods(const LoadSizes& sizes, std::uint32_t threads) {
  constexpr double radius = 0.004;
  constexpr double length = 0.5;
  constexpr double distance = 0.05;
  constexpr std::uint32_t row = 40;
  Rods rods;
  std::vector<Attachment::Hold> holds;
  for (std::uint32_t rod = 0; rod < sizes.rods; ++rod) {
    const std::uint32_t column = rod / row;
    const Vector3d start(length * column, distance * (rod % row), 0.0);
    std::vector<Vector3d> points;
    for (std::uint32_t i = 0; i <= sizes.rod_segments; ++i) {
      points.push_back(start + Vector3d(length * i / sizes.rod_segments, 0.0, 0.0));
    }
    rods.add(points, radius, rubber(radius));
    holds.push_back(pin(0, points.front()));
    holds.back().rod = rod;
  }
  Effects effects = elastic(standard_gravity);
  effects.push_back(hold(rods, holds));
  StepperOptions options;
  options.threads = threads;
  return {std::move(rods), std::move(effects), options};
}

/// [ms]
double time_of_run(Stepper& stepper, const LoadSizes& sizes, std::uint32_t substeps) {
  const auto run = [&](std::uint32_t frames) {
    for (std::uint32_t i = 0; i < frames * substeps; ++i) {
      stepper.step(frame_time / substeps);
    }
  };
  run(std::max(1U, sizes.frames / 4));
  return time_of([&] { run(sizes.frames); });
}

/// [ms]
double time_cables(const LoadSizes& sizes, std::uint32_t substeps, std::uint32_t threads) {
  EffectScene scene;
  scene.cables = sizes.cables;
  scene.segments = sizes.cable_segments;
  scene.substeps = substeps;
  scene.threads = threads;
  EffectSimulation simulation(scene, {"gravity", "stretch", "bend", "self_contact", "fiber_contact",
                                      "environment_contact", "friction"});
  simulation.run(std::max(1U, sizes.frames / 4));
  return time_of([&] { simulation.run(sizes.frames); });
}

/// [ms]
double time_rods(const LoadSizes& sizes, std::uint32_t substeps, std::uint32_t threads) {
  Stepper stepper = swinging_rods(sizes, threads);
  return time_of_run(stepper, sizes, substeps);
}

/// [ms]
double time_harness(const LoadSizes& sizes, std::uint32_t substeps, std::uint32_t threads) {
  StepperOptions options;
  options.threads = threads;
  Stepper stepper = harness_on_an_arm({sizes.branches, sizes.branch_segments}, options);
  return time_of_run(stepper, sizes, substeps);
}

/// What a planner asks: a cable over a table and a post, taken along at one end. [ms]
double time_prediction(const LoadSizes& sizes, std::uint32_t substeps, std::uint32_t threads) {
  const std::string text =
      "{substeps: " + std::to_string(substeps) +
      ", fibers: [{name: cable, shape: {arc: {from: [-0.4, 0, 0.5], to: [0.4, 0, 0.5], length: "
      "1.2}}, segments: " +
      std::to_string(sizes.cable_segments) +
      ", radius: 0.004, material: power_cable}], effects: [gravity, stretch, bend, damping, "
      "self_contact, environment_contact, friction, {attachment: [{fiber: cable, node: first}, "
      "{fiber: cable, node: last}]}], environment: {obstacles: [{id: table, half_spaces: [{coef: "
      "[0, 0, 1, 0]}]}, {id: post, primitives: [{type: cylinder, dimensions: [0.6, 0.03]}], pose: "
      "{position: [0, 0.1, 0.3]}}]}}";
  const SimDescription description = read_sim_scene(parse_yaml(text, "cable"), mesh_files("."));
  SimScene scene = make_sim_scene(description, threads);
  for (std::uint32_t i = 0; i < std::max(1U, sizes.frames / 4); ++i) {
    scene.advance();
  }
  PredictionOptions options;
  options.duration = sizes.frames * frame_time;
  const Placement end{{0.3, 0.3, 0.4}, Vector3d::UnitX(), Vector3d::UnitY()};
  return time_of([&] {
    SimScene copy = copy_sim_scene(description, scene, threads);
    follow(copy,
           std::vector<HoldTrajectory>{{0, sizes.cable_segments, {{0.8 * options.duration, end}}}});
    predict(copy, options);
  });
}

}  // namespace

void measure_loads(const LoadSizes& sizes, const std::function<void(const LoadResult&)>& report) {
  for (const int substeps : sizes.substeps) {
    for (const int threads : sizes.threads) {
      const auto add = [&](const char* scene, std::uint32_t rods, std::uint32_t segments,
                           const auto& time) {
        const auto steps = static_cast<std::uint32_t>(substeps);
        const auto wanted = static_cast<std::uint32_t>(threads);
        const double ms = time(sizes, steps, wanted);
        const std::uint32_t used = threads == 0 ? std::thread::hardware_concurrency() : wanted;
        report({scene, rods, segments, steps, used, ms / (sizes.frames * steps),
                1e3 * sizes.frames * frame_time / ms});
      };
      add("cables in contact", sizes.cables, sizes.cable_segments, time_cables);
      add("swinging rods", sizes.rods, sizes.rod_segments, time_rods);
      add("prediction of a cable", 1, sizes.cable_segments, time_prediction);
      add("harness on an arm", 1 + sizes.branches, sizes.branch_segments, time_harness);
    }
  }
}

}  // namespace fiber
