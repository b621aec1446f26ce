// Scenes that never stand on one rank: each makes its own fibres.
#include <mpi.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/mpi/distributed_files.hpp"
#include "fiber_proximity/scenes/large_scene.hpp"
#include "src/io/number.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/part_loads.hpp"
#include "src/mpi/plan.hpp"
#include "src/mpi/step_costs.hpp"
#include "src/text/quote.hpp"
#include "src/tools/mpi_tool.hpp"
#include "src/tools/plan_output.hpp"

namespace fiber {
namespace {

struct SceneRequest {
  std::string name;
  std::string segments;
  std::uint64_t seed = 1;
  std::uint32_t frame = 0;
  std::string out;
  PlanRequest plan;
  std::string sample = "4e6";  // segments
  EngineOptions engine_options;
  QueryOptions query;
};

/// A whole number that may be written as 1e9.
std::uint64_t parse_count(const std::string& option, const std::string& text) {
  constexpr double most = LargeScene::most_segments;
  const double count = parse_number<double>(text).value_or(0.0);
  if (!(count >= 1.0 && count <= most) || count != std::floor(count)) {
    throw std::invalid_argument(option + ": " + quote(text) +
                                " must be a whole number from 1 to 1e15");
  }
  return static_cast<std::uint64_t>(count);
}

/// The fibres that a rank makes; ranks with larger numbers have later ones.
DistributedFibers part_of(const Communicator& ranks, const LargeScene& scene, std::uint32_t frame) {
  const auto rank = static_cast<std::uint64_t>(ranks.rank());
  const auto size = static_cast<std::uint64_t>(ranks.size());
  const std::uint64_t begin =
      scene.fiber_count / size * rank + scene.fiber_count % size * rank / size;
  const std::uint64_t end =
      scene.fiber_count / size * (rank + 1) + scene.fiber_count % size * (rank + 1) / size;
  DistributedFibers part;
  ranks.agree(error_in([&] {
    part.parts = scene.fibers(begin, end, frame);
    for (std::uint64_t fiber = begin; fiber < end; ++fiber) {
      part.names.push_back({fiber, 0});
    }
  }));
  return part;
}

ExitCode write_scene(const SceneRequest& request) {
  if (request.out.empty()) {
    throw std::invalid_argument("--out is required, or --plan");
  }
  const LargeScene scene =
      make_large_scene(request.name, parse_count("--segments", request.segments), request.seed);
  if (!is_hdf5_name(request.out)) {
    throw std::invalid_argument("--out: " + quote(request.out) + " must end in .h5");
  }
  const Communicator ranks(MPI_COMM_WORLD);
  DistributedFileOptions options;
  options.run = request.name + ", " + std::to_string(scene.segment_count()) + " segments, seed " +
                std::to_string(request.seed) + ", frame " + std::to_string(request.frame);
  DistributedFiberWriter writer(MPI_COMM_WORLD, request.out, options);
  writer.write(0, part_of(ranks, scene, request.frame));
  writer.finish();
  return SUCCEEDED;
}

/// What a plan is made from: the whole scene if that is small, else others like it.
ExitCode plan_scene(const SceneRequest& request) {
  constexpr std::uint64_t least_of_a_part = 800;
  const std::uint64_t most = parse_count("--sample", request.sample);
  const LargeScene scene =
      make_large_scene(request.name, parse_count("--segments", request.segments), request.seed);
  const bool is_whole = scene.segment_count() <= most;
  const auto parts = static_cast<std::uint64_t>(request.plan.parts);
  if (!is_whole && most < least_of_a_part * parts) {
    throw std::invalid_argument("--sample: " + quote(request.sample) + " must be at least " +
                                std::to_string(least_of_a_part * parts) +
                                ", for so many parts to be like large ones");
  }
  if (!is_whole && most < scene.typical_segments * parts) {
    std::cerr << "warning: parts of the sample are smaller than " << scene.typical_segments
              << " segments, larger ones may have twice the halos that are planned\n";
  }
  const Communicator ranks(MPI_COMM_WORLD);
  const SampleScene sample = [&](std::uint64_t segments, std::uint64_t number) {
    return part_of(ranks, make_large_scene(request.name, segments, request.seed + number),
                   request.frame);
  };
  const std::uint64_t segments = is_whole ? scene.segment_count() : most;
  std::vector<PlannedPart> planned;
  if (is_whole) {
    planned =
        plan_of(part_loads(ranks, sample(segments, 0), request.plan.parts, request.query.margin));
  } else {
    const ScenePlan plan = sample_scene(ranks, sample, segments, request.plan.parts,
                                        request.query.margin, scene.dimensions);
    planned = grown(plan.parts, plan.law,
                    static_cast<double>(scene.segment_count()) / static_cast<double>(parts));
  }
  predict_steps(planned,
                measure_steps(ranks, sample(segments, 0), request.engine_options, request.query),
                request.plan.network);
  on_first_rank(ranks, [&] { write_plan(planned); });
  return SUCCEEDED;
}

void setup_scene(CLI::App& app, Command& command) {
  const auto request = std::make_shared<SceneRequest>();
  command = [request] {
    validate(request->query);
    if (request->plan.parts > 0) {
      return plan_scene(*request);
    }
    return write_scene(*request);
  };
  app.add_option("NAME", request->name, "one of " + join(large_scene_names()))->required();
  app.add_option("--segments", request->segments,
                 "how many, at least, in whole fibres; such as 1e9. The scene grows with them")
      ->required();
  app.add_option("--seed", request->seed, "of all that is random")
      ->check(whole_number(0))
      ->capture_default_str();
  app.add_option("--frame", request->frame, "which moment of the sway, from 0")
      ->capture_default_str();
  CLI::Option* const out = app.add_option("--out", request->out, "file to write (.h5)");
  CLI::Option* const plan = add_plan_options(
      app, request->plan, "of this scene, from a sample of it; nothing of it is written");
  plan->excludes(out);
  app.add_option("--margin", request->query.margin, "of the plan's query [m]")
      ->needs(plan)
      ->capture_default_str();
  app.add_option("--sample", request->sample,
                 "most segments of what the plan is made from; all ranks share them")
      ->needs(plan)
      ->capture_default_str();
  request->engine_options.threads = 1;
  app.add_option(
         "--threads", request->engine_options.threads,
         "most threads that each of the plan's ranks uses, 0 for as many as there are cores")
      ->check(whole_number(0))
      ->needs(plan)
      ->capture_default_str();
}

}  // namespace
}  // namespace fiber

int main(int argc, char** argv) {
  return fiber::run_mpi_tool("fiber_scene_mpi",
                             "Writes a scene of any size; each rank of mpirun makes its part",
                             fiber::setup_scene, argc, argv);
}
