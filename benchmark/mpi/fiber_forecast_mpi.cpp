// How much halo each of many ranks would have of a scene, counted on one process. What is too large
// for that is forecast from smaller scenes of the same density.
#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "fiber_proximity/scenes/scene.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/local_fibers.hpp"
#include "src/mpi/owned_fibers.hpp"
#include "src/mpi/partition.hpp"
#include "src/mpi/piece_boxes.hpp"
#include "src/tools/mpi_tool.hpp"

namespace fiber {
namespace {

struct ForecastRequest {
  std::string scene = "soup";
  std::uint64_t segments = 1'000'000;
  int parts = 2;
  double margin = 1e-4;  // [m]
  std::uint64_t sample = 4'000'000;
  std::uint64_t seed = 1;
};

/// What one rank would hold.
struct Part {
  LocalFibers fibers;
  PieceBoxes boxes;
  double own_segments = 0.0;
  double halo_segments = 0.0;

  explicit Part(const FiberRuns& runs) : own_segments(static_cast<double>(runs.segment_count())) {
    fibers.assign(runs);
    boxes.update({fibers}, false);
  }

  bool is_near(const Part& other, double margin) const {
    return !boxes.tree().empty() && !other.boxes.tree().empty() &&
           may_come_within(boxes.tree().root(), other.boxes.tree().root(), margin);
  }
};

/// Splits a scene as DistributedEngine does on so many ranks.
std::vector<Part> split(const LargeScene& scene, int count) {
  const Communicator self(MPI_COMM_SELF);
  std::vector<FiberPart> names;
  for (std::uint64_t fiber = 0; fiber < scene.fiber_count; ++fiber) {
    names.push_back({fiber, 0});
  }
  OwnedFibers all;
  all.update(self, scene.fibers(0, scene.fiber_count, 0), names);
  std::vector<PartitionObject> objects;
  for (const FiberRun& run : all.own().runs()) {
    objects.push_back(
        {all.own().node(run.begin + run.count / 2).point, static_cast<float>(run.count)});
  }
  const std::vector<int> part_of = partition(self, objects, count);
  std::vector<FiberRuns> runs(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < part_of.size(); ++i) {
    const FiberRun& run = all.own().runs()[i];
    all.own().add_to(runs[static_cast<std::size_t>(part_of[i])], run, 0, run.count);
  }
  return {runs.begin(), runs.end()};
}

void count_halos(std::vector<Part>& parts, double margin) {
  for (Part& part : parts) {
    const NearPieces pieces = part.boxes.all({part.fibers});
    for (const Part& other : parts) {
      if (&other != &part && other.is_near(part, margin)) {
        other.boxes.for_each_near(
            {other.fibers}, pieces, margin,
            [&](std::uint32_t /*run*/, std::uint64_t begin, std::uint64_t end) {
              part.halo_segments += static_cast<double>(end - begin);
            });
      }
    }
  }
}

/// Halo segments of parts for each own one.
struct HaloShare {
  double segments = 0.0;  // of a part, on average
  double mean = 0.0;
  double min = 0.0;
  double max = 0.0;
};

/// @param scenes how many, of different seeds: where a part begins is a matter of chance
HaloShare count_halo_share(const ForecastRequest& request, std::uint64_t segments,
                           std::uint64_t scenes) {
  HaloShare share{0.0, 0.0, HUGE_VAL, 0.0};
  double halo = 0.0;
  for (std::uint64_t i = 0; i < scenes; ++i) {
    std::vector<Part> parts =
        split(make_large_scene(request.scene, segments, request.seed + i), request.parts);
    count_halos(parts, request.margin);
    for (const Part& part : parts) {
      const double of_part = part.halo_segments / std::max(1.0, part.own_segments);
      share.segments += part.own_segments;
      halo += part.halo_segments;
      share.min = std::min(share.min, of_part);
      share.max = std::max(share.max, of_part);
    }
  }
  share.mean = halo / share.segments;
  share.segments /= static_cast<double>(scenes) * request.parts;
  return share;
}

/// Halos are what is near the surfaces of parts: of n segments in d dimensions a share a x + b x²
/// with x = n^(−1/d), for faces, and for edges with corners. Two sizes of parts tell a and b.
HaloShare extrapolate(const HaloShare& large, const HaloShare& small, double segments,
                      int dimensions) {
  const auto x_of = [&](double count) { return std::pow(count, -1.0 / dimensions); };
  const double x = x_of(large.segments);
  const double y = x_of(small.segments);
  const double quadratic = (small.mean / y - large.mean / x) / (y - x);
  const double linear = large.mean / x - quadratic * x;
  const double z = x_of(segments);
  const double mean = std::max(0.0, linear * z + quadratic * z * z);
  const double change = large.mean > 0.0 ? mean / large.mean : 0.0;
  return {segments, mean, change * large.min, change * large.max};
}

HaloShare forecast(const ForecastRequest& request) {
  constexpr std::uint64_t few_parts = 16;
  constexpr std::uint64_t max_scenes = 4;
  constexpr std::uint64_t times_smaller = 8;
  const LargeScene scene = make_large_scene(request.scene, request.segments, request.seed);
  if (scene.segment_count() <= request.sample) {
    return count_halo_share(request, request.segments, 1);
  }
  const auto parts = static_cast<std::uint64_t>(request.parts);
  if (request.sample / parts < scene.typical_segments) {
    throw std::invalid_argument("--sample must be at least " +
                                std::to_string(scene.typical_segments * parts) +
                                ", for so many parts to be like large ones");
  }
  const auto scenes = std::clamp<std::uint64_t>(few_parts / parts, 1, max_scenes);
  return extrapolate(count_halo_share(request, request.sample, scenes),
                     count_halo_share(request, request.sample / times_smaller, max_scenes * scenes),
                     static_cast<double>(scene.segment_count()) / request.parts, scene.dimensions);
}

ExitCode run(const ForecastRequest& request) {
  const HaloShare share = forecast(request);
  nlohmann::ordered_json line;
  line["scene"] = request.scene;
  line["segments"] = request.segments;
  line["parts"] = request.parts;
  line["own"] = share.segments;
  line["halo"] = share.mean;
  line["halo_min"] = share.min;
  line["halo_max"] = share.max;
  std::cout << line.dump() << "\n";
  return SUCCEEDED;
}

void setup(CLI::App& app, Command& command) {
  constexpr int max_parts = 1'000'000;
  const auto request = std::make_shared<ForecastRequest>();
  command = [request] { return run(*request); };
  app.add_option("--scene", request->scene, "one of " + join(large_scene_names()))
      ->capture_default_str();
  app.add_option("--segments", request->segments, "at least, in whole fibres")
      ->capture_default_str();
  app.add_option("--parts", request->parts, "among how many ranks they would be split")
      ->check(CLI::Range(1, max_parts))
      ->capture_default_str();
  app.add_option("--margin", request->margin, "[m]")->capture_default_str();
  app.add_option("--sample", request->sample, "max segments to count; larger scenes are forecast")
      ->capture_default_str();
  app.add_option("--seed", request->seed, "of all that is random")->capture_default_str();
}

}  // namespace
}  // namespace fiber

int main(int argc, char** argv) {
  return fiber::run_mpi_tool("fiber_forecast_mpi",
                             "Halos that many ranks would have, for each own segment, as JSON",
                             fiber::setup, argc, argv);
}
