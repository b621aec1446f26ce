// The scenes that come with the package.
#include <gtest/gtest.h>

#include "fiber_proximity/sim/scene/scene.hpp"
#include "support/source_folder.hpp"

namespace fiber {
namespace {

class ShippedScene : public ::testing::TestWithParam<const char*> {};

TEST_P(ShippedScene, RunsAndKeepsItsFibresWhole) {
  const auto file = test::source_folder() / "config/sim" / (std::string(GetParam()) + ".yaml");
  SimScene scene =
      make_sim_scene(read_sim_scene(load_yaml(file), mesh_files(file.parent_path())), 2);
  while (scene.stepper->time() < 2.0) {
    scene.advance();
    const Rods& rods = scene.stepper->rods();
    for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
      for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
        const double length = (rods.positions[i + 1] - rods.positions[i]).norm();
        ASSERT_NEAR(length / rods.rest_lengths[i], 1.0, 0.03)
            << scene.fiber_names[rod] << " edge " << i << " at " << scene.stepper->time() << " s";
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ShippedScene,
                         ::testing::Values("capstan", "demo", "hanging_cable", "harness", "hose",
                                           "knot", "pile", "wind"),
                         [](const auto& scene) { return std::string(scene.param); });

}  // namespace
}  // namespace fiber
