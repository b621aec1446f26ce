#include "src/sim/scene/report.hpp"

#include "fiber_proximity/sim/scene/prediction.hpp"
#include "test/sim/scene/scene_fixture.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

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
  SimTrial trial{10, 3.0, 2, 1e-4, "", 0.04};
  const SimReport good = report(scene, trial);
  EXPECT_NE(sentences(good.facts).find("stable: implicit Euler in steps of 4.17 ms"),
            std::string::npos);
  EXPECT_NE(sentences(good.facts).find("a swing of 1 Hz to lose 7.9 %"), std::string::npos);
  EXPECT_NE(sentences(good.facts).find("forces balance to 0.001 m/s a step within 2 iteration(s)"),
            std::string::npos);
  EXPECT_NE(sentences(good.facts).find("expected real-time factor 3"), std::string::npos);
  EXPECT_NE(sentences(good.facts).find("on a copy of the scene, which took 40 ms"),
            std::string::npos);
  // 5 m/s and a radius of 10 mm: 21 mm a step.
  EXPECT_NE(sentences(good.warnings).find("a gripper moves 20.8 mm a step"), std::string::npos);
  EXPECT_NE(sentences(good.warnings).find("12 substeps would be enough"), std::string::npos);

  trial.real_time_factor = 0.5;
  trial.residual = 0.006;
  const SimReport slow = report(read(scene_text(line, "[stretch]")), trial);
  ASSERT_EQ(slow.warnings.size(), 2U);
  EXPECT_NE(slow.warnings[0].find("forces do not balance within 2 iteration(s) in 10 step(s): they "
                                  "would change speeds by up to 0.006 m/s a step"),
            std::string::npos)
      << slow.warnings[0];
  EXPECT_NE(slow.warnings[1].find("expect it to fall behind"), std::string::npos);
}

/// A thin rope slides off a post, a hundred of its radii in a step. With the substeps that warnings
/// ask for it balances.
TEST_F(SimSceneTest, WarningsNameTheSubstepsThatBalanceThinFibres) {
  const std::string scene =
      "fibers: [{name: a, material: rope, radius: 1.0e-5, segments: 50, shape: {line: {from: "
      "[-0.04, 0, 0.003], to: [0.06, 0, 0.003]}}}]\n"
      "environment: {obstacles: [{id: post, pose: {orientation: [0.7071068, 0, 0, 0.7071068]}, "
      "primitives: [{type: cylinder, dimensions: [0.2, 0.002]}]}]}\n"
      "effects: [gravity, stretch, bend, environment_contact, friction: {coefficient: 0.3}]\n"
      "integrator: bdf2\n";
  constexpr std::uint32_t frames = 40;
  std::uint32_t substeps = 0;
  std::uint32_t unbalanced = 0;
  SimScene coarse = read(scene);
  for (std::uint32_t i = 0; i < frames; ++i) {
    coarse.advance();
    unbalanced += coarse.frame.unbalanced;
    for (const SimWarning& warning : frame_warnings(coarse)) {
      const std::string asked = "of its radii in a step, and with `substeps: ";
      const std::size_t place = warning.text.find(asked);
      if (place != std::string::npos) {
        const int named = std::stoi(warning.text.substr(place + asked.size()));
        substeps = std::max(substeps, static_cast<std::uint32_t>(named));
      }
    }
  }
  EXPECT_GT(unbalanced, frames);
  ASSERT_GT(substeps, 4U);
  SimScene fine = read(scene + "substeps: " + std::to_string(substeps) + "\n");
  unbalanced = 0;
  for (std::uint32_t i = 0; i < frames; ++i) {
    fine.advance();
    unbalanced += fine.frame.unbalanced;
  }
  EXPECT_LE(100 * unbalanced, frames * substeps);
}

TEST_F(SimSceneTest, ReportsWhatASceneLeavesOut) {
  const auto warnings = [&](const std::string& effects, const std::string& more = "") {
    return sentences(omissions(read(scene_text(line, effects, more))));
  };
  const std::string table =
      "environment: {obstacles: [{id: table, half_spaces: [{coef: [0, 0, 1, 1]}]}]}\n";
  EXPECT_EQ(warnings("[gravity, stretch, bend]"), "");
  EXPECT_EQ(warnings("[gravity]"), "") << "nothing stretches";
  EXPECT_EQ(warnings("[gravity, stretch, environment_contact]", table), "");
  EXPECT_EQ(warnings("[gravity, inextensible, bend]", table),
            "fibres pass through the 1 obstacle(s): the effect environment_contact is not named\n");
  EXPECT_EQ(warnings("[bend]"),
            "nothing resists stretch, so that edges may shrink to nothing or grow without limit: "
            "neither the effect stretch nor inextensible is named\n");

  std::string text = scene_text(line, "[stretch]");
  const auto with = [&](const std::string& old, const std::string& other) {
    std::string changed = text;
    changed.replace(changed.find(old), old.size(), other);
    return sentences(omissions(read(changed)));
  };
  EXPECT_EQ(with("material: rope", "material: {youngs_modulus: 1e9, density: 900}"),
            "the material of fibre 'cable' leaves values open, for which are taken: shear_modulus "
            "4e+06 Pa, bending_share 1\n");
  EXPECT_EQ(with("material: rope", "material: {preset: rope, density: 900}"), "");
  EXPECT_EQ(with("material: rope", "material: rope\n    repeat: {count: 3, offset: [0, 1, 0]}"),
            "the 3 fibres pass through each other: the effect fiber_contact is not named\n");
  text = scene_text(line, "[stretch, fiber_contact]");
  EXPECT_EQ(with("material: rope", "material: rope\n    repeat: {count: 3, offset: [0, 1, 0]}"),
            "");

  const SimReport all = report(read(scene_text(line, "[bend]")), {10, 3.0, 2, 1e-4, "", 0.04});
  EXPECT_NE(sentences(all.warnings).find("nothing resists stretch"), std::string::npos);
}

/// Of all its steps: those before the last one may be the worst.
TEST_F(SimSceneTest, AFrameTellsOfAllItsSteps) {
  SimScene scene =
      read(scene_text(line, "[gravity, stretch, bend, {attachment: [{fiber: cable, node: first}]}]",
                      "substeps: 5\niterations: 1\nresidual: 1e-9\n"));
  SimScene single =
      read(scene_text(line, "[gravity, stretch, bend, {attachment: [{fiber: cable, node: first}]}]",
                      "substeps: 5\niterations: 1\nresidual: 1e-9\n"));
  for (int frame = 0; frame < 20; ++frame) {
    scene.advance();
    double worst = 0.0;
    std::uint32_t unbalanced = 0;
    for (int step = 0; step < 5; ++step) {
      single.stepper->step(single.step_length());
      worst = std::max(worst, single.stepper->report().worst.residual);
      unbalanced += single.stepper->report().unbalanced;
    }
    EXPECT_EQ(scene.frame.worst.residual, worst);
    EXPECT_EQ(scene.frame.unbalanced, unbalanced);
    EXPECT_GT(unbalanced, 0U);
  }
}

/// A cable that is held at one end cannot follow the other one four times its length: a prediction
/// says so, when it begins, and once. What it can follow has no warning.
TEST_F(SimSceneTest, PredictionsWarnOfWhatTears) {
  const std::string text =
      scene_text(line, "[gravity, stretch, bend, damping, {attachment: [{fiber: cable}]}]");
  const SimScene start = read(text);
  const Vector3d first = start.stepper->rods().positions.front();
  const Vector3d last = start.stepper->rods().positions.back();
  const auto warnings = [&](double part) {
    SimScene scene = read(text);
    const auto node = static_cast<std::uint32_t>(scene.stepper->rods().node_count(0) - 1);
    const Placement there{first + part * (last - first), Vector3d::UnitX(), Vector3d::UnitY()};
    follow(scene, {HoldTrajectory{0, node, {{1.0, there}}}});
    PredictionOptions options;
    options.duration = 1.0;
    return predict(scene, options).warnings;
  };
  EXPECT_TRUE(warnings(0.9).empty());
  const std::vector<PredictedWarning> torn = warnings(4.0);
  ASSERT_EQ(torn.size(), 1U);
  EXPECT_NE(torn[0].text.find(" N, its greatest force (max_force), and the node is "),
            std::string::npos)
      << torn[0].text;
  // A tenth of its length is gone then.
  EXPECT_GT(torn[0].time, 0.02);
  EXPECT_LT(torn[0].time, 0.2);
}

TEST_F(SimSceneTest, TrialsAreOnCopies) {
  const SimTrial trial = try_scene(describe(scene_text(line, "[gravity, stretch, bend]")), 1);
  EXPECT_GE(trial.steps, 1U);
  EXPECT_GT(trial.real_time_factor, 0.0);
  EXPECT_GE(trial.iterations, 1U);
  EXPECT_LE(trial.residual, StepperOptions{}.residual);
}

}  // namespace
}  // namespace fiber
