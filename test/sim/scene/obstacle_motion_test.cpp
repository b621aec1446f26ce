// Obstacles of a scene that move.

#include <cmath>
#include <fstream>
#include <sstream>

#include "src/sim/scene/force_file.hpp"
#include "src/sim/scene/obstacles.hpp"
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
  refused("{path: [{time: 0}, {time: 1, angle: 800}]}", "it must be at most 3 rad: more substeps");
}

/// The links that a robot has: `hand`, a ball, and what is wrong with others.
std::vector<PlacedShape> ball_of(const std::string& link, const std::string& description) {
  if (link == "hand" && (description.empty() || description == "/other")) {
    return {{SphereShape{0.05}, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.2))}};
  }
  if (link == "flat") {
    return {{SphereShape{-1.0}, Eigen::Isometry3d::Identity()}};
  }
  throw std::invalid_argument("there is no link " + link + " in '" + description + "'");
}

std::string with_obstacle(const std::string& obstacle) {
  return scene_text(line, "[stretch, bend, environment_contact]",
                    "environment:\n  obstacles:\n    - " + obstacle + "\n");
}

class SceneLinks : public SimSceneTest {
 protected:
  SimScene read_with_links(const std::string& obstacle) {
    test_meshes::write(file_, with_obstacle(obstacle));
    return make_sim_scene(read_sim_scene(load_yaml(file_), mesh_files(""), {}, ball_of), 1);
  }
};

TEST_F(SceneLinks, AreObstaclesThatFollowTheirFrames) {
  for (const std::string id : {"", ", id: palm"}) {
    const SimScene scene = read_with_links("{link: hand, robot_description: /other" + id + "}");
    ASSERT_EQ(scene.obstacle_frames.size(), 1U);
    const FollowedObstacle& followed = scene.obstacle_frames.front();
    EXPECT_EQ(followed.frame, "hand");
    EXPECT_TRUE(followed.in_frame.isApprox(Eigen::Isometry3d::Identity(), 0.0));
    EXPECT_NE(followed.what.find(id.empty() ? "obstacle 'hand'" : "obstacle 'palm'"),
              std::string::npos);
    const EnvironmentObject& object = scene.motions()->obstacles().front().object;
    EXPECT_EQ(object.name, id.empty() ? "hand" : "palm");
    ASSERT_EQ(object.shapes.size(), 1U);
    EXPECT_EQ(std::get<SphereShape>(object.shapes[0].shape).radius, 0.05);
    EXPECT_EQ(object.shapes[0].pose.translation(), Vector3d(0, 0, 0.2));
  }
}

TEST_F(SceneLinks, ThatCannotBeAreRefused) {
  const auto refused = [&](const std::string& obstacle, const std::string& why) {
    const std::string found = error_of([&] { read_with_links(obstacle); });
    EXPECT_EQ(found.rfind(file_ + ":1", 0), 0U) << found;
    EXPECT_NE(found.find(why), std::string::npos) << found;
  };
  refused("{link: foot}", "10: environment.obstacles[0].link is foot: there is no link foot in ''");
  refused("{link: hand, robot_description: robot}", "there is no link hand in 'robot'");
  refused("{link: flat}", "radius");
  refused("{link: hand, robot_description: ''}", "robot_description is");
  refused("{link: hand, id: ''}", "name");
  refused("{link: hand, motion: {frame: tool}}", "has the unknown key 'motion'");
  refused("{link: hand, frame_id: world}", "has the unknown key 'frame_id'");
  refused("{link: [hand]}", "link");
  refused("{link: hand}\n    - {link: hand}",
          "11: environment.obstacles[1] has the id 'hand' of another obstacle");
  refused("[link]", "a map");
}

TEST_F(SceneLinks, AreForThoseWhoKnowRobots) {
  const std::string found = error(with_obstacle("{link: hand}"));
  EXPECT_NE(found.find("10: environment.obstacles[0].link is hand: links of robots are for "
                       "cable_sim"),
            std::string::npos)
      << found;
}

/// Where they follow frames of tf, that is known only as the scene begins.
TEST_F(SceneLinks, HaveRoomWhereTheyAppear) {
  const std::string text = with_obstacle("{link: hand}");
  test_meshes::write(file_, text);
  const SimDescription description = read_sim_scene(load_yaml(file_), mesh_files(""), {}, ball_of);
  const SimScene scene = make_sim_scene(description, 1);
  EnvironmentObject hand = scene.motions()->obstacles().front().object;
  const auto error_at = [&](double z) {
    hand.pose = Eigen::Isometry3d(Eigen::Translation3d(0.5, 0.0, z - 0.2));
    return error_of([&] { require_room(description, scene, hand); });
  };
  EXPECT_EQ(error_at(0.061), "no error");
  EXPECT_EQ(error_at(0.05995), "no error") << "it touches";
  EXPECT_EQ(error_at(0.05).rfind("segment ", 0), 0U) << error_at(0.05);
  EXPECT_NE(error_at(0.05).find("of fibre 'cable' is 10 mm deep inside of it, 0.1 mm is the most"),
            std::string::npos)
      << error_at(0.05);
}

}  // namespace
}  // namespace fiber
