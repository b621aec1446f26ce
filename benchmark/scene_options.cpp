#include "benchmark/scene_options.hpp"

#include "benchmark/options.hpp"
#include "fiber_proximity/scenes/scene.hpp"

namespace fiber {

void add_scene_options(CLI::App& subcommand, std::string& scene, SceneOptions& options) {
  add_value(subcommand, "--scene", scene,
            "one of " + join(scene_names()) +
                ", or a file of fibres: its frames are measured, or its points sway");
  add_value(subcommand, "--scale", options.scale, "of the number of fibres");
  add_count(subcommand, "--seed", options.seed, "of the scene", 0);
  subcommand.add_flag("--shuffle", options.shuffle, "put the fibres into random order");
}

}  // namespace fiber
