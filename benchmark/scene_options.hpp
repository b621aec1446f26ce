#pragma once

#include <string>

#include "command_line.hpp"
#include "fiber_proximity/scenes/options.hpp"

namespace fiber {

/// Adds --scene, --scale, --seed and --shuffle, which every command on a scene takes.
void add_scene_options(CLI::App& subcommand, std::string& scene, SceneOptions& options);

}  // namespace fiber
