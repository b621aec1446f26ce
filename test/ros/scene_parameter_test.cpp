// What of scenes is ROS: parameters, and meshes of packages.
#include <gtest/gtest.h>

#include "fiber_proximity/environment/scene/environment_scene.hpp"
#include "src/ros/environment/mesh_loader.hpp"
#include "src/ros/support/parameters.hpp"
#include "test/ros/mesh_files.hpp"
#include "test/support/error_of.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber::test::error_of;
using XmlRpc::XmlRpcValue;

fiber::EnvironmentScene read(const XmlRpcValue& value) {
  return fiber::read_environment_scene(to_yaml("/proximity/scene", value), MeshLoader());
}

TEST(SceneParameter, IsReadLikeAFile) {
  XmlRpcValue value;
  value["obstacles"][0]["id"] = "ball";
  value["obstacles"][0]["primitives"][0]["type"] = "sphere";
  value["obstacles"][0]["primitives"][0]["dimensions"][0] = 0.1;
  value["obstacles"][0]["pose"]["position"][0] = 1;
  value["obstacles"][0]["pose"]["position"][1] = 1.0 / 3.0;
  value["obstacles"][0]["pose"]["position"][2] = -1e-300;
  const fiber::EnvironmentScene scene = read(value);
  ASSERT_EQ(scene.obstacles.size(), 1U);
  const auto& object = scene.obstacles[0].object;
  EXPECT_EQ(object.pose.translation(), Eigen::Vector3d(1, 1.0 / 3.0, -1e-300));
  EXPECT_EQ(std::get<fiber::SphereShape>(object.shapes[0].shape).radius, 0.1);
  value["obstacles"][0]["primitives"][0]["dimensions"][0] = "thick";
  EXPECT_EQ(error_of([&] { read(value); }),
            "parameter /proximity/scene: obstacle 'ball'.primitives[0].dimensions[0] "
            "is thick, it must be a number");
}

TEST(SceneParameter, MeshesAreThoseOfPackages) {
  const test_meshes::Package package;
  XmlRpcValue value;
  value["obstacles"][0]["id"] = "table";
  XmlRpcValue& mesh = value["obstacles"][0]["meshes"][0];
  mesh["resource"] = "package://test_meshes/meshes/tetrahedron.obj";
  EXPECT_EQ(read(value).obstacles.at(0).object.shapes.size(), 1U);
  for (const char* resource :
       {"package://no_such_package/a.stl", "package://test_meshes/a.stl", "file:///etc/passwd",
        "http://localhost/a.stl", "package://test_meshes/../secret.stl"}) {
    mesh["resource"] = resource;
    const std::string reason = error_of([&] { read(value); });
    const std::string place =
        "parameter /proximity/scene: obstacle 'table'.meshes[0].resource: mesh '";
    EXPECT_EQ(reason.rfind(place + resource + "': ", 0), 0U) << reason;
  }
}

}  // namespace
}  // namespace fiber_proximity_ros
