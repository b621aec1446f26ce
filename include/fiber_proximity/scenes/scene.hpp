#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/scenes/options.hpp"

namespace fiber {

/// A scene gives its fibres at any frame; the topology is the same at all of them.
using Scene = std::function<FiberAssembly(std::uint32_t frame)>;

/// The scene of this name (see scene_names()).
/// @throws std::invalid_argument listing the names; options are judged when a frame is asked for
Scene make_scene(const std::string& name, const SceneOptions& options);

/// Names of all scenes.
std::vector<std::string> scene_names();

}  // namespace fiber
