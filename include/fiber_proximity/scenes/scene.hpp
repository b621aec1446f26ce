#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// Options of every scene.
struct SceneOptions {
  double scale = 1.0;      ///< of the number of fibres; above 0. At least one fibre remains.
  std::uint64_t seed = 1;  ///< of all that is random
  bool shuffle = false;    ///< put the fibres into random order
};

/// A scene gives its fibres at any frame; the topology is the same at all of them.
using Scene = std::function<FiberAssembly(std::uint32_t frame)>;

/// The scene of this name (see scene_names()).
/// @throws std::invalid_argument listing the names; options are judged when a frame is asked for
Scene make_scene(const std::string& name, const SceneOptions& options);

/// Names of all scenes.
std::vector<std::string> scene_names();

}  // namespace fiber
