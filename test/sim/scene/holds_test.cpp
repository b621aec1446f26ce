#include "test/sim/scene/scene_fixture.hpp"

namespace fiber {
namespace {

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

}  // namespace
}  // namespace fiber
