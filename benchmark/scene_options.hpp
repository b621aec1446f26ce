#pragma once

#include <string>

#include "fiber_proximity/scenes/scene.hpp"
#include "src/tools/command_line.hpp"

namespace fiber {

/// Adds --scene, --scale, --seed and --shuffle, which every command on a scene takes.
void add_scene_options(CLI::App& subcommand, std::string& scene, SceneOptions& options);

}  // namespace fiber
