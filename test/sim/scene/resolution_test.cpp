#include "test/sim/scene/scene_fixture.hpp"

namespace fiber {
namespace {

TEST_F(SimSceneTest, AccuracyChoosesSegmentsAndSubsteps) {
  const SimScene coarse = read(open_text(line, "accuracy: 10 %\n"));
  const SimScene fine = read(open_text(line, "accuracy: 0.001\n"));
  const SimScene second_order = read(open_text(line, "accuracy: 0.1 %\nintegrator: bdf2\n"));
  const auto segments = [](const SimScene& scene) {
    return scene.stepper->rods().node_count(0) - 1;
  };
  EXPECT_NEAR(segments(fine), 10.0 * segments(coarse), 10.0);
  EXPECT_NEAR(fine.substeps, 100.0 * coarse.substeps, 100.0);
  EXPECT_LT(second_order.substeps, fine.substeps);
  EXPECT_EQ(fine.accuracy, 0.001);
  // Given segments stay; a fibre that turns needs more.
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
  EXPECT_GT(nodes(30000), 0U) << "the finest accuracy takes more segments than there may be";
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

}  // namespace
}  // namespace fiber
