#include "benchmark/scene_options.hpp"

#include "fiber_proximity/scenes/scene.hpp"

namespace fiber {

void add_scene_options(CLI::App& subcommand, std::string& scene, SceneOptions& options) {
  subcommand.add_option("--scene", scene, "one of " + join(scene_names()))->capture_default_str();
  subcommand.add_option("--scale", options.scale, "of the number of fibres")->capture_default_str();
  subcommand.add_option("--seed", options.seed, "of the scene")
      ->check(whole_number(0))
      ->capture_default_str();
  subcommand.add_flag("--shuffle", options.shuffle, "put the fibres into random order");
}

}  // namespace fiber
