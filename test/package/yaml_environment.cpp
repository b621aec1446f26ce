// Reads what is around the fibres from YAML, and adds a cloud, as a program outside of the package
// would.
#include <fiber_proximity/environment/check_fibers.hpp>
#include <fiber_proximity/environment/occupancy_octree.hpp>
#include <fiber_proximity/environment/scene/environment_scene.hpp>
#include <iostream>
#include <memory>
#include <vector>

int main() {
  const fiber::EnvironmentScene scene = fiber::read_environment_scene(
      fiber::parse_yaml("obstacles: [{id: ball, primitives: [{type: sphere, dimensions: [0.1]}],"
                        " primitive_poses: [{position: [0, 0, 1]}]}]",
                        "world"),
      fiber::mesh_files("."));
  std::vector<fiber::EnvironmentObject> objects{scene.obstacles.at(0).object};
  const double resolution = 0.01;
  const Eigen::Vector3d point(0, 0, -1);
  objects.push_back(
      {"cloud",
       Eigen::Isometry3d::Identity(),
       {{std::make_shared<const fiber::OccupancyOctree>(
           resolution, std::vector{*fiber::OccupancyOctree::cell_at(resolution, point)})}}});
  const fiber::Environment environment(objects);
  fiber::Surroundings surroundings;
  surroundings.environment = &environment;
  surroundings.allowed = fiber::resolve(scene.allowed, {"cable"});
  std::vector<fiber::FiberCheck> checks;
  const std::vector<double> heights{1.0, 0.0, -1.0};
  std::vector<fiber::FiberAssembly> cables;
  for (const double z : heights) {
    cables.emplace_back(std::vector<Eigen::Vector3d>{{-1, 0, z}, {1, 0, z}},
                        std::vector<std::uint32_t>{0, 2}, std::vector<double>{0.005});
  }
  fiber::check_fibers(cables, surroundings, {}, checks);
  for (const fiber::FiberCheck& check : checks) {
    std::cout << (check.is_free() ? "free\n" : "touches\n");
  }
}
