// Obstacles of a scene that move.

#include <cmath>
#include <fstream>
#include <sstream>

#include "src/sim/scene/force_file.hpp"
#include "src/sim/scene/report.hpp"
#include "test/sim/scene/scene_fixture.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

std::string with_motion(const std::string& motion,
                        const std::string& effects = "[stretch, bend, environment_contact]") {
  return scene_text(line, effects,
                    "environment:\n"
                    "  obstacles:\n"
                    "    - {id: floor, planes: [{coef: [0, 0, 1, 3]}]}\n"
                    "    - id: box\n"
                    "      pose: {position: [0.5, 0, -0.1]}\n"
                    "      primitives: [{type: box, dimensions: [0.1, 0.1, 0.1]}]\n"
                    "      motion: " +
                        motion + "\n");
}

TEST_F(SimSceneTest, ObstaclesGoAlongTheirPaths) {
  SimScene scene = read(with_motion(
      "{axis: [0, 0, 2], period: 4, path: [{time: 0}, {time: 1, position: [0.5, 0.2, -0.1], "
      "angle: 6.0}, {time: 2, orientation: [0, 0, 1, 0]}]}"));
  const MovingObstacle& box = scene.motions()->obstacles().at(0);
  EXPECT_EQ(box.object.name, "box");
  EXPECT_EQ(scene.object_name(1), "box");
  EXPECT_EQ(scene.environment->objects().size(), 1U);
  const auto is_at = [&](double time, const Vector3d& position, double angle) {
    const Eigen::Isometry3d pose = box.placement(time);
    const Vector3d x = pose.linear().col(0);
    return (pose.translation() - position).norm() < 1e-12 &&
           (x - Vector3d(std::cos(angle), std::sin(angle), 0.0)).norm() < 1e-9;
  };
  EXPECT_TRUE(is_at(0.0, {0.5, 0.0, -0.1}, 0.0));
  EXPECT_TRUE(is_at(0.5, {0.5, 0.1, -0.1}, 3.0));
  EXPECT_TRUE(is_at(1.0, {0.5, 0.2, -0.1}, 6.0));
  EXPECT_TRUE(is_at(2.0, {0.5, 0.2, -0.1}, 6.0 + M_PI));
  EXPECT_TRUE(is_at(3.0, {0.5, 0.1, -0.1}, 3.0 + M_PI / 2));
  EXPECT_TRUE(is_at(4.5, {0.5, 0.1, -0.1}, 3.0));
}

TEST_F(SimSceneTest, MovingObstaclesPushAndFeelFibres) {
  const std::string text = with_motion("{path: [{time: 0}, {time: 1, position: [0.5, 0, 0.9]}]}");
  SimScene scene = read(text);
  const std::string file = folder_.path("forces.csv");
  ForceWriter writer(file);
  for (int i = 0; i < 20; ++i) {
    scene.advance();
  }
  writer.write(20, scene.stepper->rods(), scene.stepper->forces());
  writer.finish();
  EXPECT_GT(scene.stepper->rods().positions[2].z(), 0.1);
  EXPECT_TRUE(frame_warnings(scene).empty());
  EXPECT_NEAR(scene.objects().at(1).pose.translation().z(), 20.0 / 60.0 - 0.1, 1e-9);
  std::ifstream stream(file);
  std::stringstream written;
  written << stream.rdbuf();
  EXPECT_NE(written.str().find("20,obstacle,0,1,"), std::string::npos) << written.str();
  const SimScene copy = copy_sim_scene(describe(text), scene, 1);
  EXPECT_EQ(copy.objects().at(1).pose.translation(), scene.objects().at(1).pose.translation());
}

TEST_F(SimSceneTest, ObstaclesThatNothingTouchesDoNotMove) {
  const SimScene scene =
      read(with_motion("{path: [{time: 0}, {time: 1, position: [0, 0, 9]}]}", "[stretch, bend]"));
  EXPECT_EQ(scene.motions(), nullptr);
  ASSERT_EQ(omissions(scene).size(), 1U);
  EXPECT_NE(omissions(scene).front().find("the 2 obstacle(s)"), std::string::npos);
}

TEST_F(SimSceneTest, MovingObstaclesThatFibresBeginInsideOfAreRefused) {
  const std::string found = error(with_motion("{path: [{time: 0, position: [0.5, 0, -0.02]}]}"));
  EXPECT_NE(found.find("begins inside of obstacle 'box'"), std::string::npos) << found;
}

TEST_F(SimSceneTest, MotionsThatCannotBeAreRefused) {
  const auto refused = [&](const std::string& motion, const std::string& why) {
    const std::string found = error(with_motion(motion));
    EXPECT_NE(found.find(why), std::string::npos) << found;
    EXPECT_NE(found.find("box"), std::string::npos) << found;
  };
  refused("{}", "a map with either a path or a frame");
  refused("{path: [{time: 0}], frame: tool}", "a map with either a path or a frame");
  refused("{path: []}", "at least one entry");
  refused("{path: [{time: 1}]}", "0, where the path begins");
  refused("{path: [{time: 0}, {time: 2}, {time: 1}]}", "later than the time before, 2.0");
  refused("{path: [{time: 0}, {position: [0, 0, 0]}]}", "time");
  refused("{path: [{time: 0}, {time: .nan}]}", "finite");
  refused("{path: [{time: 0}, {time: 1, position: [.inf, 0, 0]}]}", "finite");
  refused("{path: [{time: 0}, {time: 1, orientation: [1, 1, 0, 0]}]}", "of length 1");
  refused("{path: [{time: 0}, {time: 1, angle: .nan}]}", "finite");
  refused("{axis: [0, 0, 0], path: [{time: 0}]}", "a direction");
  refused("{path: [{time: 0}, {time: 1, speed: 3}]}", "speed");
  refused("{period: 1, path: [{time: 0}, {time: 1}]}", "longer than the path");
  refused("{period: 1, frame: tool}", "absent where there is no path");
  refused("{path: [{time: 0}, {time: 0.1, position: [200, 0, 0]}]}", "at most 1000");
  refused("{path: [{time: 0}, {time: 0.001, angle: 100}]}", "at most 1000");
}

}  // namespace
}  // namespace fiber
