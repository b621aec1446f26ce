#include "fiber_proximity/ros/sim_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ros/mesh_files.hpp"
#include "support/error_of.hpp"
#include "support/temporary_directory.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber::test::error_of;

/// A scene with this in place of its fibre's shape, and these effects.
std::string scene_text(const std::string& shape, const std::string& effects,
                       const std::string& more = "") {
  return "fibers:\n"
         "  - name: cable\n"
         "    shape: " +
         shape +
         "\n"
         "    segments: 4\n"
         "    radius: 0.01\n"
         "    material: rope\n"
         "effects: " +
         effects + "\n" + more;
}

const char* const line = "{line: {from: [0, 0, 0], to: [1, 0, 0]}}";

class SimSceneTest : public ::testing::Test {
 protected:
  SimSceneTest() : file_(folder_.path("scene.yaml")) {}

  SimScene read(const std::string& text) {
    test_meshes::write(file_, text);
    return read_sim_scene(file_, MeshLoader(), 1);
  }

  /// The error without the file's name, which it begins with.
  std::string error(const std::string& text) {
    const std::string error = error_of([&] { read(text); });
    EXPECT_EQ(error.rfind(file_ + ":", 0), 0U) << error;
    return error.substr(std::min(error.size(), file_.size() + 1));
  }

  fiber::test::TemporaryDirectory folder_;
  std::string file_;
};

TEST_F(SimSceneTest, ShapesHaveEqualEdgesAndTheirEnds) {
  const SimScene arc = read(scene_text(
      "{arc: {from: [0, 0, 0], to: [1, 0, 0], length: 1.5, towards: [0, 1, 0]}}", "[stretch]"));
  const fiber::Rods& rods = arc.stepper->rods();
  EXPECT_EQ(rods.positions.front(), Eigen::Vector3d::Zero());
  EXPECT_NEAR((rods.positions.back() - Eigen::Vector3d::UnitX()).norm(), 0.0, 1e-9);
  EXPECT_GT(rods.positions[2].y(), 0.4);
  for (std::uint32_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(rods.rest_lengths[i], rods.rest_lengths[0], 1e-3);
  }
}

TEST_F(SimSceneTest, OnlyNamedEffectsAreMade) {
  const SimScene bare = read(scene_text(line, "[stretch, bend]"));
  EXPECT_TRUE(bare.stepper->rods().angles.empty());
  EXPECT_TRUE(bare.stepper->rods().natural_curvatures.empty());
  EXPECT_EQ(bare.attachment, nullptr);
  EXPECT_EQ(bare.effect_names, (std::vector<std::string>{"stretch", "bend"}));
  const SimScene twisted =
      read(scene_text(line, "[stretch, {bend: {natural_curvature: 2}}, twist, attachment]"));
  EXPECT_EQ(twisted.stepper->rods().angles.size(), 5U);
  EXPECT_EQ(twisted.stepper->rods().natural_curvatures, std::vector<double>(5, 2.0));
  EXPECT_NE(twisted.attachment, nullptr);
}

TEST_F(SimSceneTest, AGripperFollowsItsPathAndStopsAtItsEnd) {
  SimScene scene = read(scene_text(line,
                                   "[stretch, bend, {attachment: [{fiber: cable, node: last, path: "
                                   "[{time: 0}, {time: 0.5, position: [1, 0, 1]}]}]}]"));
  const auto run_to = [&scene](double time) {
    while (scene.stepper->time() < time - 1e-9) {
      scene.stepper->step(0.01);
    }
    return scene.stepper->rods().positions.back();
  };
  EXPECT_NEAR((run_to(0.25) - Eigen::Vector3d(1.0, 0.0, 0.5)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((run_to(0.8) - Eigen::Vector3d(1.0, 0.0, 1.0)).norm(), 0.0, 1e-9);
}

TEST_F(SimSceneTest, RepeatedFibresAreHeldAllAtOnce) {
  const SimScene scene = read(
      "fibers:\n"
      "  - {name: hair, shape: {line: {from: [0, 0, 0], to: [1, 0, 0]}}, segments: 2, radius: 1e-4,"
      " material: hair, repeat: {count: 3, offset: [0, 1, 0]}}\n"
      "effects: [stretch, {attachment: [{fiber: hair}]}]\n");
  EXPECT_EQ(scene.fiber_names, (std::vector<std::string>{"hair_0", "hair_1", "hair_2"}));
  EXPECT_EQ(scene.stepper->rods().positions[6], Eigen::Vector3d(0, 2, 0));
  for (std::uint32_t rod = 0; rod < 3; ++rod) {
    EXPECT_TRUE(scene.attachment->find(rod, 0).has_value());
  }
}

TEST_F(SimSceneTest, ErrorsNameLineAndWhatIsAllowed) {
  struct Case {
    std::string text;
    std::string error;
  };
  const std::string held = "[stretch, {attachment: [";
  const std::vector<Case> cases{
      {scene_text(line, "[gravitation]"),
       ": effects[0]: there is no effect 'gravitation', known are: attachment, bend, damping"},
      {scene_text(line, "[{gravity: {acceleratoin: [0, 0, 1]}}]"),
       "7: effects[0].gravity has the unknown key 'acceleratoin', known are: acceleration"},
      {scene_text(line, "[gravity, gravity]"), "the effect 'gravity' is there twice"},
      {scene_text(line, "[stretch, inextensible]"), "name one of them"},
      {scene_text(line, "[friction]"), "name self_contact, fiber_contact or environment_contact"},
      {scene_text(line, "[environment_contact]"), "the scene has no environment"},
      {scene_text(line, "[{damping: {relaxation_time: -1}}]"), "relaxation time is -1"},
      {scene_text(line, "[{bend: {natural_curvature: -1}}]"), "natural_curvature is -1"},
      {scene_text("{line: {from: [0, 0, 0], to: [0, 0, 0]}}", "[stretch]"),
       "fibre 'cable': rod 0: edge 0 has no length"},
      {scene_text("{circle: {}}", "[stretch]"), "has the unknown key 'circle', known are: arc"},
      {scene_text("{arc: {from: [0, 0, 0], to: [1, 0, 0], length: 0.5}}", "[stretch]"),
       "length is 0.5, it must be longer than"},
      {scene_text(line, held + "{fiber: rope}]}]"),
       "fiber is rope, it must be the name of a fibre of the scene: cable"},
      {scene_text(line, held + "{fiber: cable, node: 5}]}]"), "node is 5, it must be"},
      {scene_text(line, held + "{fiber: cable, node: 2, kind: clamp}]}]"),
       "a clamp must be at an end of the rod"},
      {scene_text(line, held + "{fiber: cable}, {fiber: cable, node: first}]}]"),
       "it is held already"},
      {scene_text(line, held + "{fiber: cable, path: [{time: 0}, {time: 0}]}]}]"),
       "time is 0, it must be later than the time before"},
      {scene_text(line, held + "{fiber: cable, path: [{time: 1}]}]}]"), "it must be 0"},
      {scene_text(line, "[stretch]", "time_step: 0\n"), "time_step is 0, it must be positive"},
      {scene_text(line, "[stretch]", "substeps: 0\n"), "substeps is 0"},
      {scene_text(line, "[stretch]", "integrator: euler\n"),
       "it must be implicit_euler or implicit_midpoint"},
      {scene_text(line, "[stretch]",
                  "environment: {obstacles: [{id: b, frame_id: arm, half_spaces: "
                  "[{coef: [0, 0, 1, 0]}]}]}\n"),
       "obstacle 'b' is in frame 'arm', it must be in the scene's, 'world'"},
  };
  for (const Case& bad : cases) {
    const std::string found = error(bad.text);
    EXPECT_NE(found.find(bad.error), std::string::npos) << found << "\nexpected " << bad.error;
  }
  std::string bad_material = scene_text(line, "[stretch]");
  bad_material.replace(bad_material.find("rope"), 4, "{youngs_modulus: -1}");
  EXPECT_NE(error(bad_material).find("fibre 'cable': youngs_modulus is -1"), std::string::npos);
}

class ShippedScene : public ::testing::TestWithParam<const char*> {};

TEST_P(ShippedScene, RunsAndKeepsItsFibresWhole) {
  SimScene scene =
      read_sim_scene(std::string(SIM_SCENES) + "/" + GetParam() + ".yaml", MeshLoader(), 2);
  while (scene.stepper->time() < 2.0) {
    for (std::uint32_t i = 0; i < scene.substeps; ++i) {
      scene.stepper->step(scene.time_step / scene.substeps);
    }
    const fiber::Rods& rods = scene.stepper->rods();
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
                         ::testing::Values("capstan", "hanging_cable", "harness", "hose", "knot",
                                           "pile", "wind"),
                         [](const auto& scene) { return std::string(scene.param); });

}  // namespace
}  // namespace fiber_proximity_ros
