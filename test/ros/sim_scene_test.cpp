#include <gtest/gtest.h>

#include <cmath>

#include "fiber_proximity/ros/sim_report.hpp"
#include "fiber_proximity/sim/effects/bend.hpp"
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
  EXPECT_TRUE(bare.stepper->rods().natural_curvature_vectors.empty());
  EXPECT_EQ(bare.attachment, nullptr);
  EXPECT_EQ(bare.effect_names, (std::vector<std::string>{"stretch", "bend"}));
  const SimScene twisted =
      read(scene_text(line, "[stretch, {bend: {natural_curvature: 2}}, twist, attachment]"));
  EXPECT_EQ(twisted.stepper->rods().angles.size(), 5U);
  EXPECT_EQ(twisted.stepper->rods().natural_curvatures, std::vector<double>(5, 2.0));
  EXPECT_TRUE(twisted.stepper->rods().natural_curvature_vectors.empty());
  EXPECT_NE(twisted.attachment, nullptr);
}

TEST_F(SimSceneTest, NaturalCurvatureHasASideWhereTheSceneSaysSo) {
  const auto rods_of = [this](const std::string& shape, const std::string& effects) {
    return read(scene_text(shape, effects)).stepper->rods();
  };
  const fiber::Rods rods =
      rods_of(line, "[stretch, {bend: {natural_curvature: 2, towards: [1, 0, -3]}}, twist]");
  EXPECT_TRUE(rods.natural_curvatures.empty());
  ASSERT_EQ(rods.natural_curvature_vectors.size(), 5U);
  for (const Eigen::Vector2d& curvature : rods.natural_curvature_vectors) {
    const Eigen::Vector3d& first = rods.directors[0];
    const Eigen::Vector3d bent =
        curvature.x() * first + curvature.y() * Eigen::Vector3d::UnitX().cross(first);
    EXPECT_NEAR((bent - Eigen::Vector3d(0, 0, -2)).norm(), 0.0, 1e-12);
  }

  const char* const helix = "{helix: {center: [0, 0, 0], radius: 1, pitch: 1, turns: 1}}";
  const fiber::Rods curled =
      rods_of(helix, "[stretch, twist, {bend: {natural_curvature: from_shape}}]");
  ASSERT_EQ(curled.natural_curvature_vectors.size(), 5U);
  EXPECT_GT(curled.natural_curvature_vectors[2].norm(), 0.5);
  EXPECT_LT(fiber::Bend().energy(curled, 0), 1e-20);
  const fiber::Rods untwisted =
      rods_of(helix, "[stretch, {bend: {natural_curvature: from_shape}}]");
  EXPECT_TRUE(untwisted.natural_curvature_vectors.empty());
  ASSERT_EQ(untwisted.natural_curvatures.size(), 5U);
  EXPECT_NEAR(untwisted.natural_curvatures[2], curled.natural_curvature_vectors[2].norm(), 1e-12);
}

/// A clamp that says nothing of how the section lies takes it as it is, at both ends.
TEST_F(SimSceneTest, ClampsDoNotTwistACurledFibre) {
  SimScene scene = read(
      scene_text("{helix: {center: [0, 0, 0], radius: 1, pitch: 1, turns: 0.7}}",
                 "[stretch, twist, {bend: {natural_curvature: from_shape}}, {attachment: [{fiber: "
                 "cable, kind: clamp}, {fiber: cable, kind: clamp, node: last}]}]"));
  const std::vector<Eigen::Vector3d> beginning = scene.stepper->rods().positions;
  for (int i = 0; i < 10; ++i) {
    scene.stepper->step(0.1);
  }
  for (std::size_t i = 0; i < beginning.size(); ++i) {
    EXPECT_NEAR((scene.stepper->rods().positions[i] - beginning[i]).norm(), 0.0, 1e-9);
  }
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
      {scene_text(line, "[{bend: {natural_curvature: -1}}]"),
       "7: effects[0].bend.natural_curvature is -1, it must be at least 0 and finite, or "
       "from_shape"},
      {scene_text(line, "[{bend: {natural_curvature: shape}}]"),
       "natural_curvature is shape, it must be at least 0 and finite, or from_shape"},
      {scene_text(line, "[{bend: {natural_curvature: 1, towards: [0, 1, 0]}}]"),
       "7: effects[0].bend.towards is [0, 1, 0], it must be absent where there is no twist"},
      {scene_text(line, "[{bend: {natural_curvature: 1, towards: [2, 0, 0]}}, twist]"),
       "7: effects[0].bend.towards is [2, 0, 0], it must be finite and a direction across the "
       "fibre's first edge (fibre 'cable')"},
      {scene_text(line, "[twist, {bend: {natural_curvature: 1, towards: 3}}]"),
       "towards is 3, it must be a list of 3 numbers"},
      {scene_text(line, "[twist, {bend: {towards: [0, 1, 0]}}]"),
       "it must be absent where there is no natural_curvature"},
      {scene_text(line, "[twist, {bend: {natural_curvature: from_shape, towards: [0, 1, 0]}}]"),
       "it must be absent where the natural curvature is from_shape"},
      {scene_text(line, "[twist, plasticity, {bend: {natural_curvature: from_shape}}]"),
       "7: effects[1]: plasticity: what stays has no direction"},
      {scene_text("{line: {from: [0, 0, 0], to: [0, 0, 0]}}", "[stretch]"),
       "2: fibers[0]: rod 0: edge 0 has no length: its points are the same (fibre 'cable')"},
      {scene_text("{circle: {}}", "[stretch]"), "has the unknown key 'circle', known are: arc"},
      {scene_text("{arc: {from: [0, 0, 0], to: [1, 0, 0], length: 0.5}}", "[stretch]"),
       "length is 0.5, it must be longer than"},
      {scene_text(line, held + "{fiber: rope}]}]"),
       "fiber is rope, it must be the name of a fibre of the scene: cable"},
      {scene_text(line, held + "{fiber: cable, node: 5}]}]"), "node is 5, it must be"},
      {scene_text(line, held + "{fiber: cable, node: 2, kind: clamp}]}]"),
       "a clamp must be at an end of the rod"},
      {scene_text(line, held + "{fiber: cable}, {fiber: cable, node: first}]}]"),
       "effects[1].attachment[1] holds node 0, which is held already: "},
      {scene_text(line, held + "{fiber: cable, path: [{time: 0}, {time: 0}]}]}]"),
       "time is 0, it must be later than the time before"},
      {scene_text(line, held + "{fiber: cable, path: [{time: 1}]}]}]"),
       "it must be 0, where the path begins (fibre 'cable')"},
      {scene_text(line, held + "{fiber: cable, path: [{time: 0}, {position: [0, 0, 1]}]}]}]"),
       "effects[1].attachment[0].path[1] has no key 'time' (fibre 'cable')"},
      {scene_text(line, held + "{fiber: cable, path: [{time: 0}, {time: .inf}]}]}]"),
       "time is .inf, it must be finite (fibre 'cable')"},
      {scene_text(line, held + "{fiber: cable, path: [{time: 0}, {time: 2}, {time: 1}]}]}]"),
       "time is 1, it must be later than the time before, 2.000000 s (fibre 'cable')"},
      {scene_text(line, held + "{fiber: cable, path: []}]}]"), "a list of at least one entry"},
      {scene_text(line, held + "{fiber: cable, path: [{time: 0, position: [0, 0, 0.3]}]}]}]"),
       "7: effects[1].attachment[0] begins 0.300000 m from where node 0 is, it must begin within "
       "0.250000 m, an edge's length (fibre 'cable')"},
      {scene_text(line, held + "{fiber: cable, position: [0, .nan, 0]}]}]"), "m from where node 0"},
      {scene_text(line, held + "{fiber: cable, path: [{time: 0}, {time: 2}], period: 2}]}]"),
       "period is 2, it must be longer than the path, 2.000000 s"},
      {scene_text(line, held + "{fiber: cable, period: 2}]}]"),
       "period is 2, it must be absent where there is no path"},
      {scene_text(line, held + "{fiber: cable, kind: clamp}, {fiber: cable, node: 0}]}]"),
       "which is held already: " + file_ + ":7: effects[1].attachment[0] (fibre 'cable')"},
      {scene_text(line, "[stretch]", "accuracy: 60 %\n"),
       "accuracy is 60 %, it must be above 0 and at most 0.5, or 50 %"},
      {scene_text(line, "[stretch]", "accuracy: 1 percent\n"), "accuracy is 1 percent"},
      {scene_text(line, "[stretch]", "accuracy: 0.01\nreal_time: true\n"),
       "real_time is true, it must be absent or false where there is an accuracy"},
      {scene_text(line, "[stretch]", "real_time: soon\n"), "real_time is soon"},
      {scene_text(line, "[stretch]", "time_step: 0\n"),
       "8: time_step is 0, it must be at least 1e-06 and at most 1000"},
      {scene_text(line, "[stretch]", "substeps: 0\n"), "substeps is 0"},
      {scene_text(line, "[stretch]", "integrator: euler\n"),
       "it must be implicit_euler or implicit_midpoint"},
      {scene_text(line, "[stretch, self_contact]", "integrator: implicit_midpoint\n"),
       "it must be implicit_euler where there are contacts"},
      {scene_text(line, "[stretch]",
                  "environment: {obstacles: [{id: b, frame_id: arm, half_spaces: "
                  "[{coef: [0, 0, 1, 0]}]}]}\n"),
       "obstacle 'b' is in frame 'arm', it must be in the scene's, 'world'"},
      {"fibers: [{name: \"a\\n\", shape: " + std::string(line) +
           ", segments: 1, radius: 0.01, material: \"ro\\npe\"}]\neffects: [stretch]\n",
       "there is no material 'ro\\npe', known are: hair, power_cable, rope, silicone_tube (fibre "
       "'a\\n')"},
  };
  for (const Case& bad : cases) {
    const std::string found = error(bad.text);
    EXPECT_NE(found.find(bad.error), std::string::npos) << found << "\nexpected " << bad.error;
  }
}

TEST_F(SimSceneTest, ErrorsOfMaterialsNameFibreAndLine) {
  for (const std::string value : {"youngs_modulus", "shear_modulus", "density"}) {
    std::string text = scene_text(line, "[stretch]");
    text.replace(text.find("rope"), 4, "{" + value + ": -1}");
    EXPECT_EQ(error(text), "6: fibers[0].material: " + value +
                               " is -1.000000, it must be positive and finite (fibre 'cable')");
  }
  std::string text = scene_text(line, "[stretch]");
  text.replace(text.find("    segments: 4\n"), 16, "");
  EXPECT_EQ(error(text), "2: fibers[0] has no key 'segments' (fibre 'cable')");
}

TEST_F(SimSceneTest, APathWithAPeriodBeginsAgain) {
  SimScene scene = read(scene_text(line,
                                   "[stretch, bend, {attachment: [{fiber: cable, node: last, path: "
                                   "[{time: 0}, {time: 1, position: [1, 0, 1]}], period: 2}]}]"));
  EXPECT_EQ(scene.fastest_hold, 1.0);
  const auto height_at = [&scene](double time) {
    while (scene.stepper->time() < time - 1e-9) {
      scene.stepper->step(0.01);
    }
    return scene.stepper->rods().positions.back().z();
  };
  EXPECT_NEAR(height_at(1.0), 1.0, 1e-9);
  EXPECT_NEAR(height_at(1.5), 0.5, 1e-9);
  EXPECT_NEAR(height_at(2.25), 0.25, 1e-9);
  EXPECT_NEAR(height_at(4.75), 0.75, 1e-9);
}

/// A scene whose fibre has no segments of its own.
std::string open_text(const std::string& shape, const std::string& more) {
  std::string text = scene_text(shape, "[gravity, stretch, bend]", more);
  text.replace(text.find("    segments: 4\n"), 16, "");
  return text;
}

TEST_F(SimSceneTest, AccuracyChoosesSegmentsAndSubsteps) {
  const SimScene coarse = read(open_text(line, "accuracy: 10 %\n"));
  const SimScene fine = read(open_text(line, "accuracy: 0.001\n"));
  const SimScene midpoint =
      read(open_text(line, "accuracy: 0.1 %\nintegrator: implicit_midpoint\n"));
  const auto segments = [](const SimScene& scene) {
    return scene.stepper->rods().node_count(0) - 1;
  };
  EXPECT_NEAR(segments(fine), 10.0 * segments(coarse), 10.0);
  EXPECT_NEAR(fine.substeps, 100.0 * coarse.substeps, 100.0);
  EXPECT_LT(midpoint.substeps, fine.substeps);
  EXPECT_EQ(fine.accuracy, 0.001);
  // What is given stays; what turns needs more.
  const SimScene given = read(scene_text(line, "[stretch]", "accuracy: 1 %\nsubsteps: 7\n"));
  EXPECT_EQ(segments(given), 4U);
  EXPECT_EQ(given.substeps, 7U);
  const SimScene coil = read(open_text(
      "{helix: {center: [0, 0, 0], radius: 0.1, pitch: 0.05, turns: 20}}", "accuracy: 1 %\n"));
  EXPECT_GT(segments(coil), 200U);
}

TEST_F(SimSceneTest, RealTimeChoosesLessForMore) {
  const auto nodes = [this](int count) {
    std::string text = open_text(line, "real_time: true\n");
    text.replace(text.find("effects"), 0,
                 "    repeat: {count: " + std::to_string(count) + ", offset: [0, 1, 0]}\n");
    const SimScene scene = read(text);
    return scene.stepper->rods().node_count(0) * scene.substeps;
  };
  EXPECT_GT(nodes(1), 4 * nodes(300));
  EXPECT_EQ(read(open_text(line, "real_time: true\n")).accuracy.has_value(), true);
}

std::string sentences(const std::vector<std::string>& list) {
  std::string text;
  for (const std::string& sentence : list) {
    text += sentence + "\n";
  }
  return text;
}

TEST_F(SimSceneTest, ReportsWhatToExpect) {
  const std::string fast =
      "[gravity, stretch, bend, self_contact, {attachment: [{fiber: cable, path: [{time: 0}, "
      "{time: "
      "1, position: [0, 0, 5]}]}]}]";
  const SimScene scene = read(scene_text(line, fast));
  SimTrial trial{10, 3.0, 0.0, ""};
  const SimReport good = report(scene, trial);
  EXPECT_NE(sentences(good.facts).find("stable: implicit Euler in steps of 4.17 ms"),
            std::string::npos);
  EXPECT_NE(sentences(good.facts).find("a swing of 1 Hz to lose 7.9 %"), std::string::npos);
  EXPECT_NE(sentences(good.facts).find("expected real-time factor 3"), std::string::npos);
  // 5 m/s and a radius of 10 mm: 21 mm a step.
  EXPECT_NE(sentences(good.warnings).find("a gripper moves 20.8 mm a step"), std::string::npos);
  EXPECT_NE(sentences(good.warnings).find("12 substeps would be enough"), std::string::npos);

  trial.real_time_factor = 0.5;
  trial.iteration_error = 0.006;
  const SimReport slow = report(read(scene_text(line, "[stretch]")), trial);
  ASSERT_EQ(slow.warnings.size(), 2U);
  EXPECT_NE(slow.warnings[0].find("2 iteration(s) were within 6 mm of 8"), std::string::npos);
  EXPECT_NE(slow.warnings[1].find("expect it to fall behind"), std::string::npos);
}

TEST_F(SimSceneTest, TrialsAreOnCopies) {
  read(scene_text(line, "[gravity, stretch, bend]"));
  const SimTrial trial = try_scene(file_, MeshLoader(), 1);
  EXPECT_GE(trial.steps, 1U);
  EXPECT_GT(trial.real_time_factor, 0.0);
  EXPECT_GE(trial.iteration_error, 0.0);
  EXPECT_LT(trial.iteration_error, 0.01);
}

fiber_proximity::SimulationParameter parameter(const std::string& name,
                                               const std::vector<double>& value) {
  fiber_proximity::SimulationParameter parameter;
  parameter.name = name;
  parameter.value = value;
  return parameter;
}

TEST_F(SimSceneTest, ParametersChangeWhatMoves) {
  SimScene scene = read(scene_text(line, "[gravity, stretch, bend, damping, drag]"));
  EXPECT_EQ(scene.parameters.all().size(), 9U);
  const auto fall = [&scene] {
    scene.stepper->step(0.01);
    return scene.stepper->rods().velocities[0];
  };
  EXPECT_LT(fall().z(), 0.0);
  scene.parameters.set(
      {parameter("gravity.acceleration", {0, 0, 0}), parameter("drag.wind.mean", {0, 300, 0})});
  const Eigen::Vector3d before = scene.stepper->rods().velocities[0];
  const Eigen::Vector3d after = fall();
  EXPECT_GE(after.z(), before.z());
  EXPECT_GT(after.y(), 0.0);
}

TEST_F(SimSceneTest, ParametersAreAllSetOrNone) {
  SimScene scene = read(scene_text(line, "[gravity, stretch, damping]"));
  EXPECT_EQ(error_of([&] {
              scene.parameters.set({parameter("gravity.acceleration", {0, 0, 1}),
                                    parameter("damping.relaxation_time", {-1})});
            }),
            "parameter 'damping.relaxation_time' is [-1.000000]: damping: the relaxation time is "
            "-1.000000 s, it must be at least 0 and finite");
  EXPECT_EQ(scene.parameters.all()[1].value, (std::vector<double>{0, 0, -9.81}));
  scene.stepper->step(0.01);
  EXPECT_LT(scene.stepper->rods().velocities[0].z(), 0.0) << "gravity was changed";
  EXPECT_EQ(error_of([&] { scene.parameters.set({parameter("drag.across", {1})}); }),
            "parameter 'drag.across' is [1.000000]: there is no such parameter, known are: "
            "damping.relaxation_time, gravity.acceleration");
  EXPECT_EQ(error_of([&] {
              scene.parameters.set({parameter("gravity.acceleration", {0, 0, -1.1e6})});
            }),
            "parameter 'gravity.acceleration' is [0.000000, 0.000000, -1100000.000000]: its "
            "numbers must be finite and at most 1e6 in magnitude");
  EXPECT_EQ(error_of([&] { scene.parameters.set({parameter("gravity.acceleration", {1})}); }),
            "parameter 'gravity.acceleration' is [1.000000]: it must be a list of 3 number(s)");
}

/// Two fibres of these shapes and this radius, which touch each other, themselves and a table.
std::string two_fibers(const std::string& a, const std::string& b, const std::string& more = "",
                       const std::string& contacts =
                           "self_contact, fiber_contact, "
                           "environment_contact, ") {
  const auto fiber = [](const std::string& name, const std::string& shape) {
    return "  - name: " + name + "\n    shape: " + shape +
           "\n    segments: 10\n    radius: 0.01\n    material: rope\n";
  };
  return "fibers:\n" + fiber("a", a) + fiber("b", b) + "effects: [" + contacts +
         "stretch, bend, twist]\nenvironment:\n  obstacles:\n    - {id: table, half_spaces: "
         "[{coef: [0.0, 0.0, 1.0, 0.0]}]}\n" +
         more;
}

const char* const high = "{line: {from: [0, 0, 1], to: [1, 0, 1]}}";
const char* const across = "{line: {from: [0.33, -0.5, 1.005], to: [0.33, 0.5, 1.005]}}";
const char* const far_away = "{line: {from: [0, 5, 1], to: [1, 5, 1]}}";

TEST_F(SimSceneTest, FibresThatBeginInEachOtherAreNamed) {
  const auto at = [this](int number) { return file_ + ":" + std::to_string(number); };
  EXPECT_EQ(error(two_fibers(high, across)),
            "2: fibers[0] begins inside of " + at(7) +
                ": fibers[1]: segment 3 of fibre 'a' and segment 4 of fibre 'b' are 15 mm deep in "
                "it, 0.2 mm is the most; so are 1 more pairs; move them apart, or have "
                "`initial_overlap: separate`");
  EXPECT_NE(error(two_fibers(high, high)).find("are 20 mm deep in it"), std::string::npos);
  EXPECT_EQ(error(two_fibers("{polyline: [[0, 0, 1], [0.4, 0, 1], [0.4, 0.3, 1], [0.2, 0.3, 1], "
                             "[0.2, -0.2, 1]]}",
                             far_away))
                .find("2: fibers[0] begins inside of itself: segment "),
            0U);
  EXPECT_EQ(error(two_fibers(far_away, "{line: {from: [0, 0, 1], to: [0, 0, 0.003]}}"))
                .find("7: fibers[1] begins inside of obstacle 'table': segment 9 of fibre 'b' is 7 "
                      "mm deep in it, 0.1 mm is the most; move them apart"),
            0U);
  EXPECT_EQ(error(two_fibers(high, far_away, "initial_overlap: maybe\n")),
            "16: initial_overlap is maybe, it must be refuse or separate");
}

TEST_F(SimSceneTest, OnlyContactsThatAreNamedMayNotBeginInEachOther) {
  EXPECT_EQ(error(two_fibers(high, across, "", "fiber_contact, ")).find("2: fibers[0] begins"), 0U);
  EXPECT_NO_THROW(read(two_fibers(high, across, "", "self_contact, environment_contact, ")));
  EXPECT_NO_THROW(read(two_fibers(high, high, "", "")));
  // They touch, and no more.
  EXPECT_NO_THROW(read(two_fibers(high, "{line: {from: [0, 0, 1.02], to: [1, 0.3, 1.02]}}")));
  EXPECT_NO_THROW(read(two_fibers(high, "{line: {from: [0, 0, 0.01], to: [1, 0, 0.01]}}")));
}

TEST_F(SimSceneTest, FibresMoveApartWhereTheSceneSaysSo) {
  const std::string separate = "initial_overlap: separate\n";
  for (const char* const other : {high, across}) {
    SimScene scene = read(two_fibers(high, other, separate));
    EXPECT_EQ(scene.overlap_note.find("initial_overlap: "), 0U) << scene.overlap_note;
    EXPECT_NE(scene.overlap_note.find("began inside of each other; nodes were moved by up to "),
              std::string::npos);
    const fiber::Rods& rods = scene.stepper->rods();
    EXPECT_NEAR(rods.rest_lengths[0], 0.1, 1e-12) << "lengths are those of the file";
    const std::vector<Eigen::Vector3d> beginning = rods.positions;
    for (int i = 0; i < 50; ++i) {
      scene.stepper->step(1.0 / 240.0);
      for (std::size_t node = 0; node < beginning.size(); ++node) {
        ASSERT_LT((rods.positions[node] - beginning[node]).norm(), 0.05) << "it bursts";
      }
    }
  }
  EXPECT_EQ(read(two_fibers(high, far_away, separate)).overlap_note, "");
  std::string held = two_fibers(high, high, separate);
  held.replace(held.find("twist"), 5,
               "twist, {attachment: [{fiber: a}, {fiber: b}, {fiber: a, node: last}]}");
  EXPECT_NE(error(held).find(", where `initial_overlap: separate` has moved them"),
            std::string::npos);
}

TEST_F(SimSceneTest, NumbersThatTakeForEverAreRefused) {
  EXPECT_EQ(error(open_text(line, "accuracy: 1e-6\n"))
                .find("7: accuracy is 1e-6, it must be "
                      "coarser: it takes "),
            0U);
  EXPECT_EQ(error(open_text(line, "accuracy: 1e-13\nsubsteps: 4\n")),
            "2: fibers[0]: the scene's accuracy takes 3741658 segments, 1000000 are the most "
            "(fibre 'cable')");
  EXPECT_LE(
      read(open_text("{line: {from: [0, 0, 0], to: [0.01, 0, 0]}}", "real_time: true\n")).substeps,
      1000U);
  std::string text = scene_text(line, "[stretch]");
  text.replace(text.find("effects"), 0, "    repeat: {count: 100000, offset: [0, 1, 0]}\n");
  EXPECT_NO_THROW(read(text));
  text.replace(text.find("segments: 4"), 11, "segments: 11");
  EXPECT_EQ(error(text),
            "7: fibers[0].repeat: 100000 fibres of 11 segments are too many, a scene has at most "
            "1000000 segments");
  for (const char* const value : {"0", "-1", ".nan", ".inf", "1e-7", "1001"}) {
    EXPECT_EQ(
        error(scene_text(line, "[stretch]", std::string("time_step: ") + value + "\n")),
        std::string("8: time_step is ") + value + ", it must be at least 1e-06 and at most 1000");
  }
  EXPECT_EQ(error(scene_text(line, "[stretch]", "max_strain: 0\n")),
            "8: max_strain is 0, it must be above 0 and at most 10");
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
                         ::testing::Values("capstan", "demo", "hanging_cable", "harness", "hose",
                                           "knot", "pile", "wind"),
                         [](const auto& scene) { return std::string(scene.param); });

}  // namespace
}  // namespace fiber_proximity_ros
