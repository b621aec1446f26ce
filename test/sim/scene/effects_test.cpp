#include "test/sim/scene/scene_fixture.hpp"

namespace fiber {
namespace {

/// A limp cable that is let go from upright folds at its hold. Damping must not keep the fold.
TEST_F(SimSceneTest, ADampedCableFoldsAndHangsDown) {
  for (const char* const effects : {"stretch, bend, twist, damping", "stretch, bend, damping"}) {
    SCOPED_TRACE(effects);
    std::string text = scene_text(
        "{line: {from: [0, 0, 0], to: [0.15, 0.22, -1.28]}}",
        std::string("[gravity, ") + effects + ", {attachment: [{fiber: cable, node: 13}]}]",
        "substeps: 4\n");
    text.replace(text.find("    segments: 4"), 15, "    segments: 17");
    text.replace(text.find("    radius: 0.01"), 16, "    radius: 0.004");
    SimScene scene = read(text);
    const std::vector<Eigen::Vector3d>& at = scene.stepper->rods().positions;
    std::uint32_t unbalanced = 0;
    double lowest = 0.0;
    for (int frame = 0; frame < 300; ++frame) {
      scene.advance();
      unbalanced += scene.frame.unbalanced;
      lowest = std::min(lowest, at.front().z() - at[13].z());
    }
    EXPECT_LE(unbalanced, 12U) << "of 1200 steps";
    EXPECT_LT(lowest, -0.8) << "the end that was up hangs down from the hold";
    EXPECT_GT(scene.stepper->rods().velocities.front().norm(), 1e-6) << "it moves on";
  }
}

TEST_F(SimSceneTest, ShapesHaveEqualEdgesAndTheirEnds) {
  const SimScene arc = read(scene_text(
      "{arc: {from: [0, 0, 0], to: [1, 0, 0], length: 1.5, towards: [0, 1, 0]}}", "[stretch]"));
  const Rods& rods = arc.stepper->rods();
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
  const Rods rods =
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
  const Rods curled = rods_of(helix, "[stretch, twist, {bend: {natural_curvature: from_shape}}]");
  ASSERT_EQ(curled.natural_curvature_vectors.size(), 5U);
  EXPECT_GT(curled.natural_curvature_vectors[2].norm(), 0.5);
  // Nothing pulls it straight.
  SimScene at_rest =
      read(scene_text(helix, "[stretch, twist, {bend: {natural_curvature: from_shape}}]"));
  at_rest.advance();
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_LE((at_rest.stepper->rods().positions[i] - curled.positions[i]).norm(), 1e-9);
  }
  const Rods untwisted = rods_of(helix, "[stretch, {bend: {natural_curvature: from_shape}}]");
  EXPECT_TRUE(untwisted.natural_curvature_vectors.empty());
  ASSERT_EQ(untwisted.natural_curvatures.size(), 5U);
  EXPECT_NEAR(untwisted.natural_curvatures[2], curled.natural_curvature_vectors[2].norm(), 1e-12);
}

TEST_F(SimSceneTest, OptionsOfEffectsAreReadAndHaveDefaults) {
  const SimDescription scene = describe(scene_text(
      line,
      "[{gravity: {acceleration: [1, 2, 3]}}, {damping: {relaxation_time: 0.5}}, {drag: {across: "
      "2, "
      "wind: {mean: [4, 5, 6], gust_period: 7}}}, {plasticity: {hardening: 0.25}}, {self_contact: "
      "{restitution: 0.5, stiffness: 8}}, {friction: {coefficient: 0.75}}, stretch]"));
  const auto options = [&scene](const char* effect) { return scene.find_effect(effect)->options; };
  using Options = EffectOptions;
  EXPECT_EQ(options("gravity"), (Options{{"acceleration", {1, 2, 3}}}));
  EXPECT_EQ(options("damping"), (Options{{"relaxation_time", {0.5}}}));
  EXPECT_EQ(options("drag"), (Options{{"fluid_density", {1.2}},
                                      {"across", {2}},
                                      {"along", {0.02}},
                                      {"wind.mean", {4, 5, 6}},
                                      {"wind.gust", {0, 0, 0}},
                                      {"wind.gust_period", {7}},
                                      {"wind.gust_length", {1}}}));
  EXPECT_EQ(options("plasticity"), (Options{{"yield_strain", {0.02}}, {"hardening", {0.25}}}));
  EXPECT_EQ(options("self_contact"), (Options{{"restitution", {0.5}}, {"stiffness", {8}}}));
  EXPECT_EQ(options("friction"), (Options{{"coefficient", {0.75}}, {"stick_speed", {1e-3}}}));
  EXPECT_EQ(options("stretch"), Options());
  EXPECT_EQ(scene.find_effect("twist"), nullptr);
}

TEST_F(SimSceneTest, OneDescriptionMakesAnyNumberOfScenes) {
  const SimDescription description = describe(
      scene_text(line,
                 "[gravity, stretch, bend, twist, {attachment: [{fiber: cable, kind: clamp, "
                 "path: [{time: 0}, {time: 1, position: [0, 0, 1]}]}]}]"));
  SimScene first = make_sim_scene(description, 1);
  for (int i = 0; i < 20; ++i) {
    first.advance();
  }
  EXPECT_GT((first.stepper->rods().positions[4] - description.rods.positions[4]).norm(), 0.1);
  EXPECT_EQ(description.rods.positions[0], Eigen::Vector3d::Zero());
  SimScene second = make_sim_scene(description, 1);
  for (int i = 0; i < 20; ++i) {
    second.advance();
  }
  EXPECT_EQ(first.stepper->rods().positions, second.stepper->rods().positions);
  EXPECT_NEAR(second.stepper->time(), 20.0 / 60.0, 1e-12);
}

}  // namespace
}  // namespace fiber
