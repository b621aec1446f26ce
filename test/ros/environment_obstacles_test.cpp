// Obstacles of the topic and the service, through the real graph: in which frames, in which order,
// and while meshes are built.
#include <chrono>
#include <cmath>
#include <future>
#include <limits>
#include <memory>

#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "fiber_proximity/ros/conversions.hpp"
#include "test/ros/environment_fixture.hpp"
#include "test/ros/gate.hpp"

namespace environment_test {
namespace {

TEST_F(EnvironmentInputsTest, ObstaclesOfTheTopicAreBroughtIntoTheFixedFrame) {
  start_with_topic();
  static_transforms.sendTransform(transform("tool", 10.0));
  publish({ball("a", 1.0), ball("b", 2.0, "tool"), ball("c", 3.0, "/tool")});
  // What waits for its transform is told as unknown: the inputs are in use from its arrival on.
  ASSERT_TRUE(wait_for([&] { return !places().empty(); }));
  EXPECT_EQ(places(), (Places{{"a", 1.0}, {"b", 12.0}, {"c", 13.0}}));
  Obstacle move = ball("b", 5.0, "tool");
  move.operation = Obstacle::MOVE;
  move.primitives.clear();
  Obstacle append = ball("a", 7.0);
  append.operation = Obstacle::APPEND;
  publish({move, append, removal("c")});
  ASSERT_TRUE(wait_for([&] { return places().size() == 2; }));
  EXPECT_EQ(places(), (Places{{"a", 1.0}, {"b", 15.0}}));
  EXPECT_EQ(inputs->environment()->objects()[0].shapes.size(), 2U);
  EXPECT_EQ(statistics_of("obstacles").received, 2U);
  EXPECT_EQ(statistics_of("obstacles").refused, 0U);
}

TEST_F(EnvironmentInputsTest, AMessageIsAppliedWholeOrNotAtAll) {
  start_with_topic();
  const auto before = inputs->environment();
  std::uint64_t refused = 0;
  const auto expect_refusal = [&](const std::vector<Obstacle>& obstacles, const std::string& name) {
    publish(obstacles);
    ++refused;
    ASSERT_TRUE(wait_for([&] { return statistics_of("obstacles").refused == refused; }));
    EXPECT_NE(statistics_of("obstacles").last_error.find("'" + name + "'"), std::string::npos)
        << statistics_of("obstacles").last_error;
    EXPECT_EQ(places(), Places());
    // The service says the same, at once.
    EXPECT_EQ(apply(obstacles), statistics_of("obstacles").last_error);
    EXPECT_EQ(places(), Places());
  };
  Obstacle bad = ball("bad");
  bad.primitives[0].type = 7;
  expect_refusal({ball("good"), bad}, "bad");
  bad = ball("bad");
  bad.pose.orientation.w = 0.5;
  expect_refusal({ball("good"), bad}, "bad");
  bad = ball("bad");
  bad.meshes.resize(1);
  bad.meshes[0].vertices.resize(3);
  bad.meshes[0].triangles.resize(1);
  bad.meshes[0].triangles[0].vertex_indices = {0, 1, 3};
  expect_refusal({ball("good"), bad}, "bad");
  bad.meshes[0].triangles[0].vertex_indices = {0, 1, 2};
  bad.meshes[0].vertices[1].z = std::numeric_limits<double>::quiet_NaN();
  expect_refusal({ball("good"), bad}, "bad");
  bad = ball("bad");
  bad.primitives[0].dimensions[0] = -1.0;
  expect_refusal({ball("good"), bad}, "bad");
  bad = ball("bad");
  bad.primitives.clear();
  expect_refusal({ball("good"), bad}, "bad");
  bad = ball("bad");
  bad.operation = Obstacle::MOVE;
  expect_refusal({ball("good"), ball("bad"), bad}, "bad");  // with a shape
  expect_refusal({ball("good"), removal("missing")}, "missing");
  expect_refusal({ball("good"), removal("good"), removal("good")}, "good");
  expect_refusal({ball("good"), ball("cloud")}, "cloud");
  expect_refusal({ball("good"), ball("robot/hand")}, "robot/hand");
  expect_refusal({ball("good"), ball("")}, "");
  EXPECT_TRUE(places().empty());
  // What was to be there is owed; "cloud" and the robot's link were never to be had.
  const std::vector<std::string> owed = unknown();
  ASSERT_FALSE(owed.empty());
  for (const char* const name : {"good: refused: ", "bad: refused: "}) {
    EXPECT_EQ(std::count_if(owed.begin(), owed.end(),
                            [name](const std::string& text) { return text.rfind(name, 0) == 0; }),
              1)
        << name;
  }
  EXPECT_TRUE(inputs->is_used()) << "there is something to be told";
  EXPECT_EQ(apply({removal("")}), "");
  EXPECT_TRUE(unknown().empty()) << "all are gone now";
  EXPECT_FALSE(inputs->is_used());
}

TEST_F(EnvironmentInputsTest, StampsOfTheFutureAreRefusedByTopicAndService) {
  start_with_topic();
  Obstacle late = ball("late");
  late.header.stamp = ros::Time::now() + ros::Duration(3600.0);
  publish({late});
  ASSERT_TRUE(wait_for([&] { return statistics_of("obstacles").refused == 1; }));
  const std::string error = statistics_of("obstacles").last_error;
  EXPECT_EQ(error.rfind("obstacle 'late': its stamp ", 0), 0U) << error;
  EXPECT_NE(error.find("it may be 1 s ahead (max_stamp_ahead)"), std::string::npos) << error;
  EXPECT_NE(apply({late}).find("(max_stamp_ahead)"), std::string::npos);
  EXPECT_TRUE(places().empty());
  late.header.stamp = ros::Time::now();
  EXPECT_EQ(apply({late}), "");
  EXPECT_TRUE(unknown().empty()) << "it is there now";
}

TEST_F(EnvironmentInputsTest, AnEmptyIdRemovesAllObstaclesOfThatMoment) {
  start();
  EXPECT_EQ(apply({ball("a"), ball("b")}), "");
  EXPECT_EQ(apply({ball("c"), removal(""), ball("d", 4.0)}), "");
  EXPECT_EQ(places(), (Places{{"d", 4.0}}));
  EXPECT_EQ(apply({removal("")}), "");
  EXPECT_EQ(apply({removal("")}), "");
  EXPECT_EQ(places(), Places());
}

TEST_F(EnvironmentInputsTest, ObstaclesWaitForTheirTransformsInTheirOrder) {
  own.setParam("obstacle_timeout", 1000.0);
  start_with_topic();
  publish({ball("a", 1.0, "late")});
  publish({ball("a", 2.0)});
  ASSERT_TRUE(wait_for([&] { return statistics_of("obstacles").received == 2; }));
  EXPECT_TRUE(inputs->is_waiting());
  EXPECT_EQ(places(), Places());
  EXPECT_NE(apply({ball("b", 1.0, "late")}).find("obstacle 'b': no transform from frame 'late'"),
            std::string::npos);
  static_transforms.sendTransform(transform("late", 10.0));
  ASSERT_TRUE(wait_for([&] { return !inputs->is_waiting(); }));
  EXPECT_EQ(places(), (Places{{"a", 2.0}}));
}

TEST_F(EnvironmentInputsTest, AnObstacleWhoseTransformDoesNotComeIsRefusedAndTheOtherApplied) {
  own.setParam("obstacle_timeout", 0.05);
  start_with_topic();
  publish({ball("lost", 1.0, "moon")});
  publish({ball("here", 2.0)});
  ASSERT_TRUE(wait_for([&] { return !places().empty() && !inputs->is_waiting(); }));
  EXPECT_EQ(places(), (Places{{"here", 2.0}}));
  EXPECT_EQ(statistics_of("obstacles").refused, 1U);
  EXPECT_NE(statistics_of("obstacles")
                .last_error.find("obstacle 'lost': no transform from frame "
                                 "'moon' to 'world'"),
            std::string::npos);
}

TEST_F(EnvironmentInputsTest, ABadObstacleEveryTimeDelaysNoOther) {
  own.setParam("obstacle_timeout", 1000.0);
  start_with_topic();
  for (int i = 1; i <= 5; ++i) {
    publish({ball("lost", i, "moon")});
    publish({ball("good", i)});
    ASSERT_TRUE(wait_for([&] { return places() == Places{{"good", i}}; })) << i;
  }
  EXPECT_TRUE(inputs->is_waiting());
  EXPECT_EQ(statistics_of("obstacles").refused, 0U);
  static_transforms.sendTransform(transform("moon", 100.0));
  ASSERT_TRUE(wait_for([&] { return !inputs->is_waiting(); }));
  EXPECT_EQ(places(), (Places{{"good", 5.0}, {"lost", 105.0}}));
}

/// A sphere of triangles, so many that they are not built at once.
Obstacle rock(const std::string& id, double x) {
  constexpr std::uint32_t rings = 21, sides = 20;
  Obstacle obstacle = test_messages::ball(id, x, 0.5, "");
  obstacle.primitives.clear();
  obstacle.meshes.resize(1);
  shape_msgs::Mesh& mesh = obstacle.meshes[0];
  for (std::uint32_t i = 0; i < rings; ++i) {
    for (std::uint32_t j = 0; j < sides; ++j) {
      const double height = M_PI * i / (rings - 1);
      const double turn = 2.0 * M_PI * j / sides;
      mesh.vertices.push_back(fiber_proximity_ros::to_message(
          0.5 * Eigen::Vector3d(std::sin(height) * std::cos(turn),
                                std::sin(height) * std::sin(turn), std::cos(height))));
    }
  }
  for (std::uint32_t i = 0; i + 1 < rings; ++i) {
    for (std::uint32_t j = 0; j < sides; ++j) {
      const std::uint32_t a = i * sides + j;
      const std::uint32_t b = i * sides + (j + 1) % sides;
      mesh.triangles.resize(mesh.triangles.size() + 2);
      mesh.triangles.end()[-2].vertex_indices = {a, a + sides, b};
      mesh.triangles.end()[-1].vertex_indices = {b, a + sides, b + sides};
    }
  }
  return obstacle;
}
constexpr std::size_t rock_triangles = 800;

Obstacle moved(const std::string& id, double x) {
  Obstacle obstacle = test_messages::ball(id, x, 0.5, "");
  obstacle.primitives.clear();
  obstacle.operation = Obstacle::MOVE;
  return obstacle;
}

template <class Value>
bool is_ready(const std::future<Value>& value) {
  return value.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

TEST_F(EnvironmentInputsTest, WhileAMeshIsBuiltEverythingElseGoesOn) {
  start_with_topic();
  Gate gate(inputs->mesh_builder());
  publish({rock("rock", 1.0), ball("with rock", 1.0)});
  publish({moved("rock", 2.0)});
  publish({ball("ball", 1.0)});
  ASSERT_TRUE(wait_for([&] { return !places().empty(); }));
  publish({ball("ball", 2.0)});
  ASSERT_TRUE(wait_for([&] { return places() == Places{{"ball", 2.0}}; }));
  EXPECT_EQ(apply({ball("of the service", 3.0)}), "");
  EXPECT_EQ(places(), (Places{{"ball", 2.0}, {"of the service", 3.0}}));
  EXPECT_TRUE(inputs->is_waiting());
  gate.open();
  ASSERT_TRUE(wait_for([&] { return !inputs->is_waiting(); }));
  EXPECT_EQ(places(),
            (Places{{"ball", 2.0}, {"of the service", 3.0}, {"rock", 2.0}, {"with rock", 1.0}}));
  const fiber::EnvironmentObject& mesh = inputs->environment()->objects()[2];
  using Mesh = std::shared_ptr<const fiber::TriangleMesh>;
  EXPECT_EQ(std::get<Mesh>(mesh.shapes.at(0).shape)->triangles().size(), rock_triangles);
  EXPECT_EQ(statistics_of("obstacles").received, 4U);
  EXPECT_EQ(statistics_of("obstacles").refused, 0U);
}

TEST_F(EnvironmentInputsTest, AMeshIsWhereItsFrameWasWhenItCame) {
  start_with_topic();
  static_transforms.sendTransform(transform("hand", 10.0));
  Obstacle held = rock("rock", 1.0);
  held.header.frame_id = "hand";
  Gate gate(inputs->mesh_builder());
  ASSERT_TRUE(node_test::wait_for([&] { return frame.knows(held.header); }));
  publish({held});
  ASSERT_TRUE(wait_for([&] { return inputs->is_waiting(); }));
  static_transforms.sendTransform(transform("hand", 20.0));
  ASSERT_TRUE(
      wait_for([&] { return frame.transform_from(held.header).translation().x() == 20.0; }));
  gate.open();
  ASSERT_TRUE(wait_for([&] { return !inputs->is_waiting(); }));
  EXPECT_EQ(places(), (Places{{"rock", 11.0}}));
}

TEST_F(EnvironmentInputsTest, ABadMeshIsRefusedByNameAndNoOtherIs) {
  start_with_topic();
  Obstacle bad = rock("bad", 1.0);
  bad.meshes[0].triangles.back().vertex_indices[2] = 1000000;
  publish({bad, ball("with bad", 1.0)});
  publish({rock("good", 2.0)});
  ASSERT_TRUE(wait_for([&] { return !places().empty(); }));
  EXPECT_EQ(places(), (Places{{"good", 2.0}}));
  EXPECT_EQ(statistics_of("obstacles").refused, 1U);
  EXPECT_EQ(statistics_of("obstacles").last_error.rfind("obstacle 'bad': mesh 0: triangle", 0), 0U)
      << statistics_of("obstacles").last_error;
}

TEST_F(EnvironmentInputsTest, ARemovalCancelsAMeshThatIsBeingBuilt) {
  start_with_topic();
  Gate gate(inputs->mesh_builder());
  publish({rock("rock", 1.0)});
  ASSERT_TRUE(wait_for([&] { return inputs->is_waiting(); }));
  publish({removal("rock")});
  ASSERT_TRUE(wait_for([&] { return !inputs->is_waiting(); }));
  publish({rock("stone", 2.0)});
  ASSERT_TRUE(wait_for([&] { return inputs->is_waiting(); }));
  EXPECT_EQ(apply({removal("")}), "");
  EXPECT_FALSE(inputs->is_waiting());
  EXPECT_EQ(statistics_of("obstacles").overtaken, 2U);
  EXPECT_EQ(statistics_of("obstacles").refused, 0U);
  publish({rock("last", 3.0)});
  ASSERT_TRUE(wait_for([&] { return inputs->is_waiting(); }));
  ASSERT_EQ(unknown(), (std::vector<std::string>{"last: its change is not made yet"}));
  gate.open();
  ASSERT_TRUE(wait_for([&] { return !places().empty(); }));
  EXPECT_EQ(places(), (Places{{"last", 3.0}}));
  EXPECT_TRUE(unknown().empty());
  EXPECT_NE(apply({removal("rock")}), "");
}

TEST_F(EnvironmentInputsTest, TheServiceAnswersWhenTheMeshIsThere) {
  start_with_topic();
  Gate gate(inputs->mesh_builder());
  auto answer = apply_meanwhile({rock("rock", 1.0)});
  auto other = apply_meanwhile({ball("other", 3.0)});  // not held up
  ASSERT_TRUE(wait_for([&] { return is_ready(other); }));
  publish({ball("ball", 2.0)});
  ASSERT_TRUE(wait_for([&] { return places() == Places{{"ball", 2.0}, {"other", 3.0}}; }));
  EXPECT_FALSE(is_ready(answer));
  gate.open();
  ASSERT_TRUE(wait_for([&] { return is_ready(answer); }));
  EXPECT_EQ(answer.get(), "");
  EXPECT_EQ(other.get(), "");
  EXPECT_EQ(places().count("rock"), 1U);
  Obstacle bad = rock("bad", 1.0);
  bad.meshes[0].triangles.back().vertex_indices[2] = 1000000;
  answer = apply_meanwhile({bad});
  ASSERT_TRUE(wait_for([&] { return is_ready(answer); }));
  EXPECT_EQ(answer.get().rfind("obstacle 'bad': mesh 0: triangle", 0), 0U);
}

TEST_F(EnvironmentInputsTest, EndsWhileAMeshIsBeingBuiltAndAServiceWaitsForIt) {
  start_with_topic();
  Gate gate(inputs->mesh_builder());
  publish({rock("of the topic", 1.0)});
  ASSERT_TRUE(wait_for([&] { return inputs->is_waiting(); }));
  auto answer = std::async(std::launch::async, [&] {
    fiber_proximity::ApplyObstacles service;
    service.request.obstacles = {rock("of the topic", 2.0)};
    node_test::call_service_alone(own.resolveName("apply_obstacles"), service);
    gate.open();  // the worker ends with this job
    return service.response.success != 0;
  });
  // The first one answers only after the second one has been taken in, behind it or not.
  auto after = apply_meanwhile({ball("after", 1.0)});
  ASSERT_TRUE(wait_for([&] { return is_ready(after); }));
  inputs.reset();
  EXPECT_FALSE(answer.get());
}

}  // namespace
}  // namespace environment_test
