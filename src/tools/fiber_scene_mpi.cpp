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
#include "fiber_proximity/scenes/scene.hpp"
#include "src/io/number.hpp"
#include "src/mpi/communicator.hpp"
#include "src/text/quote.hpp"
#include "src/tools/mpi_tool.hpp"

namespace fiber {
namespace {

struct SceneRequest {
  std::string name;
  std::string segments;
  std::uint64_t seed = 1;
  std::uint32_t frame = 0;
  std::string out;
};

/// A whole number that may be written as 1e9.
std::uint64_t parse_segments(const std::string& text) {
  constexpr double max = LargeScene::max_segments;
  const double count = parse_number<double>(text).value_or(0.0);
  if (!(count >= 1.0 && count <= max) || count != std::floor(count)) {
    throw std::invalid_argument("--segments: " + quote(text) +
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
  ranks.throw_on_all(error_in([&] {
    part.parts = scene.fibers(begin, end, frame);
    for (std::uint64_t fiber = begin; fiber < end; ++fiber) {
      part.names.push_back({fiber, 0});
    }
  }));
  return part;
}

ExitCode write_scene(const SceneRequest& request) {
  const LargeScene scene =
      make_large_scene(request.name, parse_segments(request.segments), request.seed);
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

void setup_scene(CLI::App& app, Command& command) {
  const auto request = std::make_shared<SceneRequest>();
  command = [request] { return write_scene(*request); };
  app.add_option("NAME", request->name, "one of " + join(large_scene_names()))->required();
  app.add_option("--segments", request->segments,
                 "how many, at least, in whole fibres; such as 1e9. The scene grows with them")
      ->required();
  app.add_option("--seed", request->seed, "of all that is random")
      ->check(whole_number(0))
      ->capture_default_str();
  app.add_option("--frame", request->frame, "which moment of the sway, from 0")
      ->capture_default_str();
  app.add_option("--out", request->out, "file to write (.h5)")->required();
}

}  // namespace
}  // namespace fiber

int main(int argc, char** argv) {
  return fiber::run_mpi_tool("fiber_scene_mpi",
                             "Writes a scene of any size; each rank of mpirun makes its part",
                             fiber::setup_scene, argc, argv);
}
