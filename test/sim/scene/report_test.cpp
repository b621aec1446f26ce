#include "src/sim/scene/report.hpp"

#include "test/sim/scene/scene_fixture.hpp"

namespace fiber {
namespace {

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

TEST_F(SimSceneTest, TrialsAreOnCopies) {
  const SimTrial trial = try_scene(describe(scene_text(line, "[gravity, stretch, bend]")), 1);
  EXPECT_GE(trial.steps, 1U);
  EXPECT_GT(trial.real_time_factor, 0.0);
  EXPECT_GE(trial.iterations, 1U);
  EXPECT_LE(trial.residual, StepperOptions{}.residual);
}

}  // namespace
}  // namespace fiber
