#include <stdexcept>
#include <string>
#include <utility>

#include "fiber_proximity/scenes/scene.hpp"
#include "src/scenes/large_scenes.hpp"
#include "src/text/join.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

using LargeSceneFunction = LargeScene (*)(std::uint64_t segments, std::uint64_t seed);

const std::vector<std::pair<std::string, LargeSceneFunction>>& large_scenes() {
  static const std::vector<std::pair<std::string, LargeSceneFunction>> all{
      {"soup", large_soup},
      {"tress_b", many_tresses},
      {"locks", many_locks},
  };
  return all;
}

void require_part(const LargeScene& scene, std::uint64_t begin, std::uint64_t end) {
  if (begin > end || end > scene.fiber_count) {
    throw std::invalid_argument("fibres from " + std::to_string(begin) + " to before " +
                                std::to_string(end) + ", there are " +
                                std::to_string(scene.fiber_count));
  }
  constexpr std::uint64_t max_points = (std::uint64_t{1} << 31U) - 1;
  const std::uint64_t most = max_points / (scene.segments_per_fiber + 1);
  if (end - begin > most) {
    throw std::invalid_argument(std::to_string(end - begin) +
                                " fibres in one part, there may be at most " +
                                std::to_string(most) + ": make more parts");
  }
}

}  // namespace

LargeScene make_large_scene(const std::string& name, std::uint64_t segments, std::uint64_t seed) {
  for (const auto& [scene_name, make] : large_scenes()) {
    if (name != scene_name) {
      continue;
    }
    if (segments == 0 || segments > LargeScene::max_segments) {
      throw std::invalid_argument("segments is " + std::to_string(segments) +
                                  ", it must be from 1 to " +
                                  std::to_string(LargeScene::max_segments));
    }
    LargeScene scene = make(segments, seed);
    scene.fibers = [unseen = scene](std::uint64_t begin, std::uint64_t end, std::uint32_t frame) {
      require_part(unseen, begin, end);
      return unseen.fibers(begin, end, frame);
    };
    return scene;
  }
  throw std::invalid_argument("unknown scene " + quote(name) +
                              ", known are: " + join(large_scene_names()));
}

std::vector<std::string> large_scene_names() {
  std::vector<std::string> names;
  for (const auto& entry : large_scenes()) {
    names.push_back(entry.first);
  }
  return names;
}

}  // namespace fiber
