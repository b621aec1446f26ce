#include "fiber_proximity/scenes/scene.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/io/number.hpp"
#include "src/scenes/hair.hpp"
#include "src/scenes/portable_math.hpp"
#include "src/scenes/scenes.hpp"
#include "src/text/join.hpp"
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
  }
  throw std::invalid_argument("unknown scene " + quote(name) +
                              ", known are: " + join(scene_names()));
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const auto& entry : scenes()) {
    names.push_back(entry.first);
  }
  return names;
}

std::uint32_t scaled_fiber_count(const SceneOptions& options, std::uint32_t full_count,
                                 std::uint32_t points_per_fiber, std::uint32_t max_fibers) {
  constexpr double max_points = 0x1p31 - 1.0;
  const double limit = std::min<double>(std::floor(max_points / points_per_fiber), max_fibers);
  const double fibers = std::floor(options.scale * full_count + 0.5);
  if (!(options.scale > 0.0) || fibers > limit) {
    throw std::invalid_argument("scale is " + text_of(options.scale) +
                                ", it must be above 0 and at most " +
                                text_of(std::floor(100.0 * limit / full_count) / 100.0));
  }
  return fibers < 1.0 ? 1U : static_cast<std::uint32_t>(fibers);
}

FiberAssembly equal_fibers(std::vector<Eigen::Vector3d> points, std::uint32_t points_per_fiber,
                           double radius) {
  std::vector<std::uint32_t> offsets(points.size() / points_per_fiber + 1);
  for (std::size_t i = 1; i < offsets.size(); ++i) {
    offsets[i] = offsets[i - 1] + points_per_fiber;
  }
  return {std::move(points), std::move(offsets), {radius}};
}

std::vector<std::uint32_t> random_order(std::uint32_t count, std::uint64_t seed) {
  // Apart from the scene's own numbers, which begin with the seed itself.
  Random random(~seed);
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  for (std::uint32_t left = count; left > 1; --left) {
    // Rounding may reach the upper limit.
    const auto chosen = static_cast<std::uint32_t>(random.uniform(0.0, left));
    std::swap(order[left - 1], order[std::min(chosen, left - 1)]);
  }
  return order;
}

}  // namespace fiber
