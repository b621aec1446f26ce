#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/scenes/scene.hpp"
#include "test/tools/tools_test.hpp"

namespace fiber::test {
namespace {

using FiberSceneTool = ToolsTest;

TEST_F(FiberSceneTool, WritesTheSceneItNames) {
  for (const std::string& name : scene_names()) {
    SCOPED_TRACE(name);
    const Scene expected = make_scene(name, {0.002, 9});
    const ProcessResult result =
        scene(name + " --scale 0.002 --seed 9 --frames 3 --out " + path("a.csv"));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out + result.err, "");
    const FiberFile file = read_csv(path("a.csv"));
    ASSERT_TRUE(file.has_frames);
    ASSERT_EQ(file.frames.size(), 3U);
    for (std::uint32_t frame = 0; frame < 3; ++frame) {
      EXPECT_EQ(file.frames[frame].frame, frame);
      EXPECT_EQ(file.frames[frame].fibers.points(), expected(frame).points());
      EXPECT_EQ(file.frames[frame].fibers.offsets(), expected(frame).offsets());
    }
  }
}

TEST_F(FiberSceneTool, WithoutFramesThereIsNoFrameColumn) {
  EXPECT_EQ(scene("soup --scale 0.001 --out " + path("a.csv")).exit_code, 0);
  const FiberFile file = read_csv(path("a.csv"));
  EXPECT_FALSE(file.has_frames);
  EXPECT_EQ(file.frames.at(0).fibers.radii(), std::vector<double>{3.5e-5});
}

TEST_F(FiberSceneTool, WritesAHairFile) {
  EXPECT_EQ(scene("charming --scale 0.001 --out " + path("a.hair")).exit_code, 0);
  const FiberAssembly fibers = read_hair(path("a.hair")).frames.at(0).fibers;
  EXPECT_EQ(fibers.offsets(), make_scene("charming", {0.001, 1})(0).offsets());
  EXPECT_TRUE(refused(scene("charming --scale 0.001 --frames 2 --out " + path("b.hair")),
                      "a .hair file cannot hold this"));
  EXPECT_FALSE(std::filesystem::exists(path("b.hair")));
}

TEST_F(FiberSceneTool, ShufflesOnRequest) {
  EXPECT_EQ(scene("soup --scale 0.001 --shuffle --out " + path("a.csv")).exit_code, 0);
  EXPECT_EQ(read_csv(path("a.csv")).frames.at(0).fibers.points(),
            make_scene("soup", {0.001, 1, true})(0).points());
}

TEST_F(FiberSceneTool, RefusesBadCommandLines) {
  const std::string out = " --out " + path("a.csv");
  EXPECT_TRUE(refused(scene(""), "required"));
  EXPECT_TRUE(refused(scene("soup"), "--out is required"));
  EXPECT_TRUE(refused(scene("spaghetti" + out), "'spaghetti', known are: "));
  EXPECT_TRUE(refused(scene("soup --scale 0" + out), "scale is 0"));
  EXPECT_TRUE(refused(scene("soup --scale nan" + out), "scale is nan"));
  EXPECT_TRUE(refused(scene("soup --frames 0" + out), "--frames: '0'"));
  EXPECT_TRUE(refused(scene("soup --seed -1" + out), "--seed: '-1'"));
  EXPECT_TRUE(refused(scene("soup --speed 1" + out), "--speed"));
  EXPECT_FALSE(std::filesystem::exists(path("a.csv"))) << "a refusal leaves no file behind";
  EXPECT_TRUE(refused(scene("soup --scale 0.001 --out /no/such/place/a.csv"),
                      "/no/such/place/a.csv: cannot be opened for writing"));
  EXPECT_TRUE(refused(scene("soup --scale 0.001 --out /dev/full"), "/dev/full: cannot be written"));
}

}  // namespace
}  // namespace fiber::test
