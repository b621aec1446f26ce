#include "test/sim/scene/scene_fixture.hpp"

namespace fiber {
namespace {

TEST_F(SimSceneTest, ParametersChangeWhatMoves) {
  SimScene scene = read(scene_text(line, "[gravity, stretch, bend, damping, drag]"));
  EXPECT_EQ(scene.parameters.all().size(), 9U);
  const auto fall = [&scene] {
    scene.stepper->step(0.01);
    return scene.stepper->rods().velocities[0];
  };
  EXPECT_LT(fall().z(), 0.0);
  scene.parameters.set({{"gravity.acceleration", {0, 0, 0}}, {"drag.wind.mean", {0, 300, 0}}});
  const Eigen::Vector3d before = scene.stepper->rods().velocities[0];
  const Eigen::Vector3d after = fall();
  EXPECT_GE(after.z(), before.z());
  EXPECT_GT(after.y(), 0.0);
}

TEST_F(SimSceneTest, ParametersAreAllSetOrNone) {
  SimScene scene = read(scene_text(line, "[gravity, stretch, damping]"));
  EXPECT_EQ(error_of([&] {
              scene.parameters.set(
                  {{"gravity.acceleration", {0, 0, 1}}, {"damping.relaxation_time", {-1}}});
            }),
            "parameter 'damping.relaxation_time' is [-1.000000]: damping: the relaxation time is "
            "-1.000000 s, it must be at least 0 and finite");
  EXPECT_EQ(scene.parameters.all()[1].value, (std::vector<double>{0, 0, -9.81}));
  scene.stepper->step(0.01);
  EXPECT_LT(scene.stepper->rods().velocities[0].z(), 0.0) << "gravity was changed";
  EXPECT_EQ(error_of([&] {
              scene.parameters.set({{"drag.across", {1}}});
            }),
            "parameter 'drag.across' is [1.000000]: there is no such parameter, known are: "
            "damping.relaxation_time, gravity.acceleration");
  EXPECT_EQ(error_of([&] {
              scene.parameters.set({{"gravity.acceleration", {0, 0, -1.1e6}}});
            }),
            "parameter 'gravity.acceleration' is [0.000000, 0.000000, -1100000.000000]: its "
            "numbers must be finite and at most 1e6 in magnitude");
  EXPECT_EQ(error_of([&] {
              scene.parameters.set({{"gravity.acceleration", {1}}});
            }),
            "parameter 'gravity.acceleration' is [1.000000]: it must be a list of 3 number(s)");
}

}  // namespace
}  // namespace fiber
