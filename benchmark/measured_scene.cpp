#include "benchmark/measured_scene.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "benchmark/swaying.hpp"
#include "fiber_proximity/io/fiber_file.hpp"
#include "src/scenes/scenes.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

std::vector<FiberAssembly> frames_of(const std::string& path, const SceneOptions& options) {
  if (options.scale != 1.0) {
    throw std::invalid_argument("scale is of the package's scenes, not of a file: " + quote(path));
  }
  std::vector<FiberAssembly> frames;
  for (FiberFrame& frame : read_fibers(path).frames) {
    if (!frames.empty() && (frame.fibers.offsets() != frames.front().offsets() ||
                            frame.fibers.radii() != frames.front().radii())) {
      throw std::invalid_argument(quote(path) + ": frame " + std::to_string(frame.frame) +
                                  " has other fibres, numbers of points or radii than the first; "
                                  "frames of one topology can be measured");
    }
    frames.push_back(std::move(frame.fibers));
  }
  if (frames.empty() || frames.front().segment_count() == 0) {
    throw std::invalid_argument(quote(path) + " has no segments");
  }
  if (options.shuffle) {
    const auto count = static_cast<std::uint32_t>(frames.front().fiber_count());
    for (FiberAssembly& frame : frames) {
      frame = select_fibers(frame, random_order(count, options.seed));
    }
  }
  return frames;
}

/// The frame that is shown at a time, there and back again.
std::size_t frame_at(std::uint32_t time, std::size_t count) {
  const std::size_t way = 2 * (count - 1);
  const std::size_t at = time % way;
  return std::min(at, way - at);
}

}  // namespace

bool is_scene_file(const std::string& name) {
  return name.find_first_of("./") != std::string::npos;
}

Scene measured_scene(const std::string& name, const SceneOptions& options, double motion) {
  if (!is_scene_file(name)) {
    return make_scene(name, options);
  }
  const auto frames = std::make_shared<const std::vector<FiberAssembly>>(frames_of(name, options));
  if (frames->size() > 1) {
    return [frames](std::uint32_t time) { return (*frames)[frame_at(time, frames->size())]; };
  }
  const FiberAssembly& fibers = frames->front();
  const auto swaying =
      std::make_shared<Swaying>(fibers, motion * mean_segment_length(fibers), options.seed);
  return [frames, swaying](std::uint32_t time) {
    FiberAssembly moved = frames->front();
    moved.update_points(swaying->points(time));
    return moved;
  };
}

double motion_of(const Scene& scene) {
  const FiberAssembly first = scene(0);
  const FiberAssembly second = scene(1);
  double sum = 0.0;
  for (std::size_t i = 0; i < first.point_count(); ++i) {
    sum += (second.points()[i] - first.points()[i]).norm();
  }
  return sum / static_cast<double>(first.point_count()) / mean_segment_length(first);
}

}  // namespace fiber
