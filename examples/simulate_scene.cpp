// Simulates a scene file for a second and says where the lowest point of each frame is.
//   simulate_scene config/sim/knot.yaml
#include <algorithm>
#include <cstdio>
#include <exception>
#include <fiber_proximity/environment/scene/environment_scene.hpp>
#include <fiber_proximity/sim/scene/scene.hpp>
#include <fiber_proximity/yaml/yaml_field.hpp>
#include <filesystem>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: simulate_scene SCENE.yaml\n");
    return 2;
  }
  try {
    const fiber::MeshSource meshes =
        fiber::mesh_files(std::filesystem::path(argv[1]).parent_path());
    fiber::SimScene scene =
        fiber::make_sim_scene(fiber::read_sim_scene(fiber::load_yaml(argv[1]), meshes), 0);
    while (scene.stepper->time() < 1.0) {
      scene.advance();
      const auto& points = scene.stepper->rods().positions;
      const auto lowest = std::min_element(
          points.begin(), points.end(), [](const auto& a, const auto& b) { return a.z() < b.z(); });
      std::printf("%.3f s: the lowest point is at %.4f m\n", scene.stepper->time(), lowest->z());
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
