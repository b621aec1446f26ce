#include "fiber_proximity/scenes/scene.hpp"

#include <stdexcept>
#include <utility>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/scenes/cables.hpp"
#include "src/scenes/cloth.hpp"
#include "src/scenes/hair_styles.hpp"
#include "src/scenes/shuffle.hpp"
#include "src/scenes/soup.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

using SceneFunction = FiberAssembly (*)(const SceneOptions& options, std::uint32_t frame);

template <const HairStyle& style>
FiberAssembly styled(const SceneOptions& options, std::uint32_t frame) {
  return hair(style, options, frame);
}

const std::vector<std::pair<std::string, SceneFunction>>& scenes() {
  static const std::vector<std::pair<std::string, SceneFunction>> all{
      {"cables", cables},
      {"tress_a", styled<tress_a>},
      {"tress_b", styled<tress_b>},
      {"tress_c", styled<tress_c>},
      {"charming", styled<charming>},
      {"curly", styled<curly>},
      {"windy", styled<windy>},
      {"longish", styled<longish>},
      {"cloth", cloth},
      {"soup", soup},
  };
  return all;
}

}  // namespace

Scene make_scene(const std::string& name, const SceneOptions& options) {
  std::string known;
  for (const auto& [scene_name, scene] : scenes()) {
    if (name == scene_name) {
      return [options, function = scene](std::uint32_t frame) {
        FiberAssembly fibers = function(options, frame);
        if (!options.shuffle) {
          return fibers;
        }
        const auto count = static_cast<std::uint32_t>(fibers.fiber_count());
        return select_fibers(fibers, random_order(count, options.seed));
      };
    }
    known += (known.empty() ? "" : ", ") + scene_name;
  }
  throw std::invalid_argument("unknown scene " + quote(name) + ", known are: " + known);
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const auto& entry : scenes()) {
    names.push_back(entry.first);
  }
  return names;
}

}  // namespace fiber
