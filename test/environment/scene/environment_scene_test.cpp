#include "fiber_proximity/environment/scene/environment_scene.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "test/support/error_of.hpp"
#include "test/support/mesh_files.hpp"
#include "test/support/temporary_directory.hpp"

namespace fiber {
namespace {

using test::error_of;

const char* const everything = R"(
obstacles:
  - id: table
    frame_id: base
    pose: {position: [1, 2, 3], orientation: [0, 0, 1, 0]}
    primitives:
      - {type: box, dimensions: [1, 2, 3]}
      - {type: sphere, dimensions: [0.5]}
      - {type: cylinder, dimensions: [4, 0.25]}
      - {type: cone, dimensions: [5, 0.125]}
    primitive_poses:
      - {}
      - {position: [0, 0, 1]}
      - {orientation: [1, 0, 0, 0]}
      - {}
    capsules: [{radius: 0.5, length: 2}]
    meshes:
      - {resource: meshes/tetrahedron.obj, scale: [2, 2, 2]}
      - {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], triangles: [[0, 1, 2]]}
    planes: [{coef: [0, 0, 1, -1]}]
    plane_poses: [{}]
  - id: ground
    half_spaces: [{coef: [0, 0, 1, 0]}]
allowed:
  - {object: robot/gripper, fiber: cable, segments: [-3, -1]}
  - {object: ground}
)";

class EnvironmentSceneTest : public ::testing::Test {
 protected:
  EnvironmentSceneTest() : file_(folder_.path("scene.yaml")) {
    test_meshes::write(folder_.path("meshes/tetrahedron.obj"), test_meshes::tetrahedron);
  }

  EnvironmentScene read(const std::string& text) {
    test_meshes::write(file_, text);
    return read_environment_scene(load_yaml(file_), mesh_files(folder_.path("")));
  }

  /// The error without the file's name, which it begins with.
  std::string error(const std::string& text) {
    const std::string error = error_of([&] { read(text); });
    EXPECT_EQ(error.rfind(file_ + ":", 0), 0U) << error;
    return error.substr(file_.size() + 1);
  }

  /// The error of one obstacle with these fields, on the second line.
  std::string error_in_obstacle(const std::string& fields) {
    return error("obstacles:\n  - {id: table, " + fields + "}");
  }

  const test::TemporaryDirectory folder_;
  const std::string file_;
};

TEST_F(EnvironmentSceneTest, EveryFieldIsRead) {
  const auto scene = read(everything);
  ASSERT_EQ(scene.obstacles.size(), 2U);
  const SceneObstacle& table = scene.obstacles[0];
  EXPECT_EQ(table.frame_id, "base");
  EXPECT_EQ(table.object.name, "table");
  EXPECT_EQ(table.object.pose * Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(0, 1, 4));
  const auto& shapes = table.object.shapes;
  ASSERT_EQ(shapes.size(), 8U);
  EXPECT_EQ(std::get<BoxShape>(shapes[0].shape).size, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(shapes[1].pose.translation(), Eigen::Vector3d::UnitZ());
  EXPECT_EQ(std::get<CylinderShape>(shapes[2].shape).height, 4.0);
  EXPECT_EQ(shapes[2].pose * Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(1, -1, -1));
  EXPECT_EQ(std::get<ConeShape>(shapes[3].shape).radius, 0.125);
  EXPECT_EQ(std::get<CapsuleShape>(shapes[4].shape).length, 2.0);
  const auto mesh = [&shapes](std::size_t i) {
    return std::get<std::shared_ptr<const TriangleMesh>>(shapes[i].shape);
  };
  EXPECT_EQ(mesh(5)->triangles().size(), 4U);
  double largest = 0.0;
  for (const Eigen::Vector3d& vertex : mesh(5)->vertices()) {
    largest = std::max(largest, vertex.maxCoeff());
  }
  EXPECT_EQ(largest, 2.0);
  EXPECT_EQ(mesh(6)->triangles().size(), 1U);
  EXPECT_EQ(std::get<PlaneShape>(shapes[7].shape).offset, 1.0);
  EXPECT_EQ(scene.obstacles[1].frame_id, "");
  EXPECT_TRUE(std::holds_alternative<HalfSpaceShape>(scene.obstacles[1].object.shapes[0].shape));
  ASSERT_EQ(scene.allowed.size(), 2U);
  EXPECT_EQ(scene.allowed[0].object, "robot/gripper");
  EXPECT_EQ(scene.allowed[0].fiber, "cable");
  EXPECT_EQ(scene.allowed[0].segments, (std::vector<std::int32_t>{-3, -1}));
  EXPECT_EQ(scene.allowed[1].fiber, "");
  EXPECT_TRUE(scene.allowed[1].segments.empty());
}

TEST_F(EnvironmentSceneTest, ErrorsNameFileLineFieldAndWhatIsAllowed) {
  EXPECT_EQ(error("just text"),
            "1: the document is just text, it must be a map of the keys obstacles, allowed");
  EXPECT_EQ(error("\nobjects: []"),
            "2: the document has the unknown key 'objects', known are: obstacles, allowed");
  EXPECT_EQ(error("obstacles: {}"), "1: obstacles is {}, it must be a list");
  EXPECT_EQ(error("obstacles: [7]"),
            "1: obstacles[0] is 7, it must be a map of the keys id, frame_id, pose, primitives, "
            "primitive_poses, capsules, capsule_poses, meshes, mesh_poses, planes, plane_poses, "
            "half_spaces, half_space_poses");
  EXPECT_EQ(error("obstacles:\n- {frame_id: base}"), "2: obstacles[0] has no key 'id'");
  EXPECT_EQ(error("allowed:\n- {object: [table]}"),
            "2: allowed[0].object is [table], it must be a text");
  EXPECT_EQ(error("allowed:\n- {object: table, segments: [0, one]}"),
            "2: allowed[0].segments[1] is one, it must be a whole number from -2147483648 to "
            "2147483647");
  EXPECT_EQ(error("allowed:\n- {object: table, segments: [0, 1.5]}").rfind("2: allowed[0]", 0), 0U);
  EXPECT_EQ(error("allowed:\n- {object: table, segments: [4]}"),
            "2: allowed[0]: pair of object 'table' and fiber '', segments [4]: segments must be "
            "the first and the last one, or empty");
  EXPECT_EQ(error("allowed:\n- {link: hand}"),
            "2: allowed[0] has the unknown key 'link', known are: object, fiber, segments");
  EXPECT_EQ(error("a: [\n").substr(0, 2), "2:");
  EXPECT_EQ(error_of([] { load_yaml("/no/such/file.yaml"); }),
            "file '/no/such/file.yaml': there is no such file to read");
}

/// So many times `item`, the first of them with a name for the others.
std::string repeated(const std::string& item, const std::string& alias, int count) {
  std::string list = "[&" + alias + " " + item;
  for (int i = 1; i < count; ++i) {
    list += ", *" + alias;
  }
  return list + "]";
}

TEST_F(EnvironmentSceneTest, AliasesStandForWhatTheyName) {
  const auto scene =
      read("obstacles: [{id: a, capsules: " + repeated("{radius: 0.1, length: 1}", "c", 20) + "}]");
  EXPECT_EQ(scene.obstacles.at(0).object.shapes.size(), 20U);
}

TEST_F(EnvironmentSceneTest, AliasesThatMultiplyAreRefused) {
  constexpr int count = 1000;
  const std::string mesh = "{vertices: " + repeated("[0, 1, 2]", "v", count) +
                           ", triangles: " + repeated("[0, 1, 2]", "t", count) + "}";
  const std::string text = "obstacles:\n- {id: a, meshes: " + repeated(mesh, "m", count) + "}\n";
  EXPECT_EQ(error(text), "2: with its aliases written out the document has more than " +
                             std::to_string(10 * text.size()) + " values, 10 per byte");
  EXPECT_EQ(error("obstacles: &a [*a]"), "1: an alias is part of what it stands for");
}

TEST_F(EnvironmentSceneTest, ErrorsInAnObstacleNameIt) {
  const auto error_in = [this](const std::string& fields) {
    return error("obstacles:\n  - id: table\n    " + fields);
  };
  const std::string here = "3: obstacle 'table'.";
  EXPECT_EQ(error_in("primitives: [{type: pyramid, dimensions: [1]}]"),
            here + "primitives[0].type is pyramid, it must be box, sphere, cylinder or cone");
  EXPECT_EQ(error_in("primitives: [{type: box, size: [1]}]"),
            here + "primitives[0] has the unknown key 'size', known are: type, dimensions");
  EXPECT_EQ(error_in("primitives: [{type: box}]"), here + "primitives[0] has no key 'dimensions'");
  EXPECT_EQ(error_in("pose: {position: [1, 2]}"),
            here + "pose.position is [1, 2], it must be a list of 3 numbers");
  EXPECT_EQ(error_in("pose: {position: [1, 2, x]}"),
            here + "pose.position[2] is x, it must be a number");
  EXPECT_EQ(error_in("pose: {orientation: [0, 0, 1]}"),
            here + "pose.orientation is [0, 0, 1], it must be a list of 4 numbers");
  EXPECT_EQ(error_in("pose: [0, 0, 1]"),
            here + "pose is [0, 0, 1], it must be a map of the keys position, orientation");
  EXPECT_EQ(error_in("capsules: [{radius: 1}]"), here + "capsules[0] has no key 'length'");
  EXPECT_EQ(error_in("planes: [{coef: [0, 0, 1]}]"),
            here + "planes[0].coef is [0, 0, 1], it must be a list of 4 numbers");
  EXPECT_EQ(error_in("meshes: [{vertices: [], triangles: [[0, -1, 2]]}]"),
            here +
                "meshes[0].triangles[0][1] is -1, it must be a whole number from 0 to "
                "4294967295");
  EXPECT_EQ(error_in("meshes: [{vertices: [], triangles: [[0, 1]]}]"),
            here + "meshes[0].triangles[0] is [0, 1], it must be a list of 3 indices of vertices");
  EXPECT_EQ(error_in("meshes: [{resource: a.stl, vertices: []}]"),
            here + "meshes[0] has the unknown key 'vertices', known are: resource, scale");
}

TEST_F(EnvironmentSceneTest, WhatTheMessagesRefuseIsRefusedWithThePlace) {
  EXPECT_EQ(error_in_obstacle("pose: {orientation: [0, 0, 0, 0], position: [1, 0, 0]}"),
            "2: obstacles[0]: obstacle 'table': pose: orientation (0, 0, 0, 0) has length 0, it "
            "must be a quaternion of length 1");
  EXPECT_EQ(error_in_obstacle("primitives: [{type: sphere, dimensions: [1, 2]}]"),
            "2: obstacles[0]: obstacle 'table': primitive 0: a sphere has 2 dimension(s), it must "
            "have 1: the radius");
  EXPECT_EQ(error_in_obstacle("mesh_poses: [{}]"),
            "2: obstacles[0]: obstacle 'table': 1 pose(s) of 0 mesh(s); give one for each or none");
  const std::string mesh =
      error_in_obstacle("meshes: [{vertices: [[0, 0, 0]], triangles: [[0, 0, 1]]}]");
  EXPECT_EQ(mesh.rfind("2: obstacles[0]: obstacle 'table': mesh 0: ", 0), 0U) << mesh;
  EXPECT_EQ(
      error("obstacles:\n- {id: robot/hand}").rfind("2: obstacles[0]: obstacle 'robot/hand'", 0),
      0U);
  EXPECT_EQ(error("obstacles:\n- {id: a}"),
            "2: obstacles[0]: object 'a': an object to add or to append to needs at least 1 shape, "
            "it has none");
  const std::string ball = "primitives: [{type: sphere, dimensions: [1]}]}";
  EXPECT_EQ(error("obstacles:\n- {id: a, " + ball + "\n- {id: a, " + ball),
            "3: obstacles[1] has the id 'a' of another obstacle of the scene");
  EXPECT_EQ(error("obstacles:\n- {id: a, id: b}"), "2: obstacles[0] has the key 'id' twice");
}

TEST_F(EnvironmentSceneTest, ResourcesThatDoNotResolveNameTheObstacle) {
  for (const char* resource : {"package://any/a.stl", "a.stl", "file:///no/such/a.stl", ""}) {
    const std::string reason =
        error_in_obstacle(std::string("meshes: [{resource: '") + resource + "'}]");
    const std::string place = "2: obstacle 'table'.meshes[0].resource: mesh '";
    EXPECT_EQ(reason.rfind(place + resource + "': ", 0), 0U) << reason;
  }
}

TEST_F(EnvironmentSceneTest, WhatIsNoFileOfASceneIsRefused) {
  EXPECT_EQ(error_of([] { load_yaml("/"); }), "file '/': there is no such file to read");
  EXPECT_EQ(error_of([] { load_yaml("/dev/zero"); }),
            "file '/dev/zero': it may have at most 100000000 bytes");
}

}  // namespace
}  // namespace fiber
