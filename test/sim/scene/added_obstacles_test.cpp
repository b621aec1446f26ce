// Obstacles that come, move and go while a scene runs: beside scenes that have them all along.

#include "src/sim/scene/obstacles.hpp"
#include "src/sim/scene/report.hpp"
#include "test/sim/scene/scene_fixture.hpp"

namespace fiber {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

std::string ball(const std::string& id, const std::string& position, const std::string& motion) {
  return "    - {id: " + id + ", pose: {position: " + position +
         "}, primitives: [{type: sphere, dimensions: [0.1]}], motion: " + motion + "}\n";
}

/// A cable without weight, and these obstacles beside a floor.
std::string with_obstacles(const std::string& obstacles) {
  return scene_text(line, "[stretch, bend, environment_contact, friction]",
                    "environment:\n  obstacles:\n"
                    "    - {id: floor, planes: [{coef: [0, 0, 1, 3]}]}\n" +
                        obstacles);
}

EnvironmentObject ball_at(const std::string& name, const Vector3d& position) {
  EnvironmentObject object;
  object.name = name;
  object.pose.translation() = position;
  object.shapes.push_back({SphereShape{0.1}, Isometry3d::Identity()});
  return object;
}

void run(SimScene& scene, int frames) {
  for (int i = 0; i < frames; ++i) {
    scene.advance();
  }
}

const std::vector<Vector3d>& nodes_of(const SimScene& scene) {
  return scene.stepper->rods().positions;
}

class AddedObstacles : public SimSceneTest {};

/// The path of the one begins when the other comes.
TEST_F(AddedObstacles, PushAsThoseOfTheScene) {
  const double begin = 10.0 / 60.0;
  SimScene expected = read(with_obstacles(
      ball("ball", "[0.5, 0, -0.2]",
           "{path: [{time: 0}, {time: " + std::to_string(begin) +
               "}, {time: " + std::to_string(begin + 0.5) + ", position: [0.5, 0.05, 0.1]}]}")));
  SimScene scene = read(with_obstacles(""));
  EXPECT_EQ(scene.motions(), nullptr) << "nothing is computed for obstacles that may come";
  run(expected, 10);
  run(scene, 10);
  add_obstacle(scene, ball_at("ball", {0.5, 0.0, -0.2}));
  const AddedObstacle* const added = find_added(scene, "ball");
  ASSERT_NE(added, nullptr);
  move_obstacle(scene, *added, ball_at("", {0.5, 0.05, 0.1}).pose, 0.5);
  double strongest = 0.0;
  for (int frame = 0; frame < 40; ++frame) {
    run(expected, 1);
    run(scene, 1);
    for (std::size_t i = 0; i < nodes_of(scene).size(); ++i) {
      ASSERT_LT((nodes_of(scene)[i] - nodes_of(expected)[i]).norm(), 1e-6) << frame;
    }
    const RodForces forces = scene.stepper->forces();
    ASSERT_EQ(forces.obstacles.size(), 1U);
    EXPECT_EQ(forces.obstacles[0].object, 1U);
    strongest = std::max(strongest, forces.obstacles[0].force.norm());
  }
  EXPECT_GT(nodes_of(scene)[2].z(), 0.1);
  EXPECT_GT(strongest, 0.0);
  EXPECT_EQ(scene.object_name(1), "ball");
  EXPECT_TRUE(placed(scene, *added).pose.translation().isApprox(Vector3d(0.5, 0.05, 0.1), 1e-12));
}

/// What sticks to one by friction still does when another one that came before it has gone.
TEST_F(AddedObstacles, ThatGoLeaveTheOthersAsTheyAre) {
  std::string text = with_obstacles(ball("mine", "[0.1, 0, 0.5]", "{path: [{time: 0}]}"));
  text.replace(text.find("friction]"), 9,
               "friction, damping, {attachment: [{fiber: cable}, {fiber: cable, node: last}]}]");
  // The ball lifts the middle of the cable and draws it to the side.
  const auto make = [&](bool has_other) {
    SimScene scene = read(text);
    if (has_other) {
      add_obstacle(scene, ball_at("other", {0.5, 5.0, 0.0}));
    }
    add_obstacle(scene, ball_at("ball", {0.5, 0.0, -0.1101}));
    move_obstacle(scene, *find_added(scene, "ball"), ball_at("", {0.5, 0.001, -0.1}).pose, 0.2);
    run(scene, 40);
    return scene;
  };
  SimScene expected = make(false);
  SimScene scene = make(true);
  EXPECT_EQ(nodes_of(scene), nodes_of(expected));
  EXPECT_GT(expected.stepper->forces().obstacles[1].force.norm(), 0.0);
  remove_obstacle(scene, *find_added(scene, "other"));
  EXPECT_EQ(find_added(scene, "other"), nullptr);
  EXPECT_EQ(scene.object_name(2), "ball");
  EXPECT_TRUE(scene.stepper->forces().obstacles.empty()) << "those of the next step";
  for (SimScene* const each : {&expected, &scene}) {
    move_obstacle(*each, *find_added(*each, "ball"), ball_at("", {0.5, 0.002, -0.1}).pose, 0.3);
    run(*each, 20);
  }
  EXPECT_EQ(nodes_of(scene), nodes_of(expected));
  EXPECT_NEAR(scene.stepper->energy(), expected.stepper->energy(), 1e-12);
  const RodForces forces = scene.stepper->forces();
  ASSERT_EQ(forces.obstacles.size(), 2U);
  EXPECT_EQ(forces.obstacles[1].force, expected.stepper->forces().obstacles[1].force);
}

TEST_F(AddedObstacles, ThatGoPushNoMore) {
  SimScene scene = read(with_obstacles(""));
  add_obstacle(scene, ball_at("ball", {0.5, 0.0, -0.1101}));
  move_obstacle(scene, *find_added(scene, "ball"), ball_at("", {0.5, 0.0, 0.1}).pose, 0.2);
  run(scene, 10);
  remove_obstacle(scene, *find_added(scene, "ball"));
  EXPECT_EQ(scene.motions(), nullptr);
  EXPECT_EQ(scene.objects().size(), 1U);
  run(scene, 1);
  EXPECT_TRUE(scene.stepper->forces().obstacles.empty());
  EXPECT_TRUE(scene.stepper->forces().contacts.empty());
  EXPECT_TRUE(frame_warnings(scene).empty());
}

TEST_F(AddedObstacles, AreThereInCopies) {
  const std::string text = with_obstacles("");
  SimScene scene = read(text);
  add_obstacle(scene, ball_at("other", {0.5, 5.0, 0.0}));
  add_obstacle(scene, ball_at("ball", {0.5, 0.0, -0.1101}));
  replace_shapes(scene, *find_added(scene, "other"),
                 {{SphereShape{0.2}, Isometry3d::Identity()},
                  {BoxShape{Vector3d(1, 1, 1)}, Isometry3d::Identity()}});
  move_obstacle(scene, *find_added(scene, "ball"), ball_at("", {0.5, 0.0, 0.1}).pose, 0.5);
  run(scene, 10);
  SimScene copy = copy_sim_scene(describe(text), scene, 1);
  run(scene, 10);
  // What becomes of the scene does not concern the copy.
  move_obstacle(scene, *find_added(scene, "ball"), ball_at("", {0.5, 0.0, -0.5}).pose, 0.1);
  run(copy, 10);
  EXPECT_EQ(nodes_of(copy), nodes_of(scene));
  ASSERT_EQ(copy.objects().size(), 3U);
  EXPECT_EQ(copy.objects()[2].shapes.size(), 2U) << "it came again, behind the other one";
  remove_obstacle(scene, *find_added(scene, "ball"));
  EXPECT_NE(find_added(copy, "ball"), nullptr);
}

TEST_F(AddedObstacles, NeedSomethingThatTouchesThem) {
  SimScene scene = read(scene_text(line, "[stretch, bend]"));
  EXPECT_EQ(error_of([&] {
              add_obstacle(scene, ball_at("ball", {0, 0, 1}));
            }),
            "nothing would touch an obstacle: there are no contacts with any");
  SimScene touched = read(with_obstacles(""));
  EXPECT_NE(error_of([&] { add_obstacle(touched, ball_at("ball", {0, 0, 1e300})); }), "no error");
  EXPECT_EQ(error_of([&] { touched.stepper->remove_obstacle(0); }),
            "there are no obstacles that move");
  add_obstacle(touched, ball_at("ball", {0, 0, 1}));
  EXPECT_EQ(error_of([&] { touched.stepper->remove_obstacle(1); }),
            "there is no moving obstacle 1, there are 1");
}

}  // namespace
}  // namespace fiber
