// EnvironmentInputs through the real graph: obstacles, allowed pairs, scene, robot.
#include "src/ros/environment/environment_inputs.hpp"

#include <algorithm>
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

using fiber::test::error_of;
using fiber_proximity::ObstacleArray;

class EnvironmentInputsTest : public EnvironmentFixture {
 protected:
  void publish(const std::vector<Obstacle>& obstacles) {
    ObstacleArray message;
    message.obstacles = obstacles;
    publisher_.publish(message);
  }

  /// A sphere of triangles, so many that they are not built at once.
  static Obstacle rock(const std::string& id, double x) {
    constexpr std::uint32_t rings = 21, sides = 20;
    Obstacle obstacle = ball(id, x);
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
  static constexpr std::size_t rock_triangles = 800;

  static Obstacle moved(const std::string& id, double x) {
    Obstacle obstacle = ball(id, x);
    obstacle.primitives.clear();
    obstacle.operation = Obstacle::MOVE;
    return obstacle;
  }

  /// Calls the service while this thread goes on.
  std::future<std::string> apply_meanwhile(const std::vector<Obstacle>& obstacles) const {
    return std::async(std::launch::async, [this, obstacles] {
      fiber_proximity::ApplyObstacles service;
      service.request.obstacles = obstacles;
      EXPECT_TRUE(ros::service::call(own.resolveName("apply_obstacles"), service));
      return service.response.message;
    });
  }

  template <class Value>
  static bool is_ready(const std::future<Value>& value) {
    return value.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }

  void start_with_topic() {
    start();
    publisher_ = advertise<ObstacleArray>("obstacles");
  }

  ros::Publisher publisher_;
};

TEST_F(EnvironmentInputsTest, NothingIsSubscribedToUnlessItIsConfigured) {
  start();
  EXPECT_FALSE(inputs->is_used());
  EXPECT_EQ(inputs->cloud(), nullptr);
  EXPECT_EQ(inputs->statistics(ros::Time::now()).size(), 1U);
  ros::V_string topics;
  ros::this_node::getSubscribedTopics(topics);
  EXPECT_EQ(std::count_if(topics.begin(), topics.end(),
                          [this](const std::string& topic) {
                            return topic.rfind(own.getNamespace(), 0) == 0;
                          }),
            1);
  EXPECT_EQ(apply({ball("ball")}), "");
  EXPECT_TRUE(inputs->is_used());
}

TEST_F(EnvironmentInputsTest, ObstaclesOfTheTopicAreBroughtIntoTheFixedFrame) {
  start_with_topic();
  static_transforms.sendTransform(transform("tool", 10.0));
  publish({ball("a", 1.0), ball("b", 2.0, "tool"), ball("c", 3.0, "/tool")});
  ASSERT_TRUE(wait_for([&] { return inputs->is_used(); }));
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
  EXPECT_FALSE(inputs->is_used());
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

TEST_F(EnvironmentInputsTest, UpdateTellsThatAServiceHasChangedSomething) {
  start();
  EXPECT_FALSE(inputs->update(ros::Time::now()));
  EXPECT_EQ(apply({ball("a")}), "");
  EXPECT_TRUE(inputs->update(ros::Time::now()));
  EXPECT_FALSE(inputs->update(ros::Time::now()));
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
  ASSERT_TRUE(wait_for([&] { return inputs->is_used() && !inputs->is_waiting(); }));
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

TEST_F(EnvironmentInputsTest, WhileAMeshIsBuiltEverythingElseGoesOn) {
  start_with_topic();
  Gate gate(inputs->mesh_builder());
  publish({rock("rock", 1.0), ball("with rock", 1.0)});
  publish({moved("rock", 2.0)});
  publish({ball("ball", 1.0)});
  ASSERT_TRUE(wait_for([&] { return inputs->is_used(); }));
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
  ASSERT_TRUE(wait_for([&] { return inputs->is_used(); }));
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
  gate.open();
  ASSERT_TRUE(wait_for([&] { return inputs->is_used(); }));
  EXPECT_EQ(places(), (Places{{"last", 3.0}}));
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
    ros::service::call(own.resolveName("apply_obstacles"), service);
    gate.open();  // the worker ends with this job
    return service.response.success != 0;
  });
  // The first one answers only after the second one has been taken in, behind it or not.
  auto after = apply_meanwhile({ball("after", 1.0)});
  ASSERT_TRUE(wait_for([&] { return is_ready(after); }));
  inputs.reset();
  EXPECT_FALSE(answer.get());
}

TEST_F(EnvironmentInputsTest, PairsAreAllowedByTheSceneAndTheService) {
  XmlRpc::XmlRpcValue scene;
  scene["allowed"][0]["object"] = "table";
  scene["allowed"][0]["fiber"] = "cable";
  own.setParam("scene", scene);
  start();
  ASSERT_EQ(inputs->allowed({"rope", "cable"}).size(), 1U);
  EXPECT_EQ(inputs->allowed({"rope", "cable"})[0].fiber, 1U);
  fiber_proximity::AllowPairs::Request request;
  request.allow.resize(1);
  request.allow[0].object = "robot/hand";
  request.allow[0].segments = {-3, -1};
  auto response = call<fiber_proximity::AllowPairs>("allow_pairs", request);
  EXPECT_TRUE(response.success) << response.message;
  EXPECT_EQ(response.allowed.size(), 2U);
  EXPECT_EQ(inputs->allowed({"rope", "cable"}).size(), 2U);
  EXPECT_TRUE(inputs->update(ros::Time::now()));
  request.reset = true;
  request.allow[0].segments = {1};
  response = call<fiber_proximity::AllowPairs>("allow_pairs", request);
  EXPECT_FALSE(response.success);
  EXPECT_NE(response.message.find("'robot/hand'"), std::string::npos);
  EXPECT_EQ(response.allowed.size(), 2U);
}

TEST_F(EnvironmentInputsTest, TheSceneIsThereAndItsObstaclesWithoutTransformAreUnknown) {
  XmlRpc::XmlRpcValue scene;
  for (int i = 0; i < 2; ++i) {
    XmlRpc::XmlRpcValue& obstacle = scene["obstacles"][i];
    obstacle["id"] = i == 0 ? "table" : "shelf";
    obstacle["primitives"][0]["type"] = "sphere";
    obstacle["primitives"][0]["dimensions"][0] = 0.5;
  }
  scene["obstacles"][1]["frame_id"] = "wall";
  own.setParam("scene", scene);
  start();
  EXPECT_TRUE(inputs->is_used());
  EXPECT_EQ(places(), (Places{{"table", 0.0}}));
  ASSERT_EQ(inputs->unknown().size(), 1U);
  EXPECT_EQ(inputs->unknown()[0].rfind("obstacle 'shelf': no transform from frame 'wall'", 0), 0U);
  static_transforms.sendTransform(transform("wall", 3.0));
  ASSERT_TRUE(wait_for([&] { return inputs->unknown().empty(); }));
  EXPECT_EQ(places(), (Places{{"shelf", 3.0}, {"table", 0.0}}));
}

TEST_F(EnvironmentInputsTest, TheRobotMovesWithTfAndALinkWithoutIsUnknown) {
  node.setParam("test_robot",
                "<robot name=\"arm\">"
                "<link name=\"arm\"><collision><geometry><sphere radius=\"1\"/></geometry>"
                "</collision></link>"
                "<link name=\"hand\"><collision><geometry><sphere radius=\"1\"/></geometry>"
                "</collision></link>"
                "<joint name=\"wrist\" type=\"floating\"><parent link=\"arm\"/>"
                "<child link=\"hand\"/></joint></robot>");
  own.setParam("robot", true);
  own.setParam("robot_description_param", "test_robot");
  own.setParam("robot_timeout", 1000.0);
  start();
  EXPECT_TRUE(inputs->is_used());
  tf2_ros::TransformBroadcaster transforms;
  const auto move = [&](const std::string& link, double x) {
    EXPECT_TRUE(wait_for([&] {
      transforms.sendTransform(transform(link, x));
      const Places places = this->places();
      return places.count("robot/" + link) != 0 && places.at("robot/" + link) == x;
    }));
  };
  move("arm", 1.0);
  ASSERT_EQ(inputs->unknown().size(), 1U);
  EXPECT_EQ(inputs->unknown()[0].rfind("robot/hand: no transform from frame 'hand'", 0), 0U);
  EXPECT_EQ(places().size(), 1U);
  move("hand", 2.0);
  EXPECT_TRUE(inputs->unknown().empty());
  move("arm", 3.0);
  EXPECT_EQ(apply({ball("ball"), removal("")}), "");
  EXPECT_EQ(places(), (Places{{"robot/arm", 3.0}, {"robot/hand", 2.0}}));
}

TEST_F(EnvironmentInputsTest, TheRobotIsWhereItWasAtTheTimeOfTheFibres) {
  node.setParam("test_robot",
                "<robot name=\"ball\"><link name=\"thrown\"><collision><geometry>"
                "<sphere radius=\"1\"/></geometry></collision></link></robot>");
  own.setParam("robot", true);
  own.setParam("robot_description_param", "test_robot");
  start();
  tf2_ros::TransformBroadcaster transforms;
  const ros::Time begin = ros::Time::now();
  const auto send = [&](double time) {
    geometry_msgs::TransformStamped thrown = transform("thrown", time);
    thrown.header.stamp = begin + ros::Duration(time);
    transforms.sendTransform(thrown);
  };
  const auto place_at = [&](double time) {
    inputs->update(begin + ros::Duration(time));
    const Places places = this->places();
    return places.empty() ? -1.0 : places.at("robot/thrown");
  };
  ASSERT_TRUE(node_test::wait_for([&] {
    send(0.0);
    send(0.5);
    return place_at(0.5) == 0.5;
  }));
  EXPECT_NEAR(place_at(0.25), 0.25, 1e-6);
  EXPECT_EQ(place_at(0.75), 0.5);  // not known yet: the latest
  EXPECT_EQ(place_at(2.0), -1.0);  // too old for that
}

TEST_F(EnvironmentInputsTest, BadParametersAreRefusedByName) {
  const auto error_with = [&](const std::string& name, const XmlRpc::XmlRpcValue& value) {
    own.deleteParam("");
    own.setParam(name, value);
    const std::string error = error_of([&] { options(); });
    EXPECT_NE(error.find(own.resolveName(name)), std::string::npos) << error;
    return error;
  };
  EXPECT_NE(error_with("scene", 7), "no error");
  XmlRpc::XmlRpcValue scene;
  scene["objects"] = 1;
  EXPECT_NE(error_with("scene", scene).find("unknown key 'objects'"), std::string::npos);
  EXPECT_NE(error_with("robot", "yes"), "no error");
  node.deleteParam("robot_description");
  EXPECT_NE(error_with("robot", true).find("/robot_description"), std::string::npos);
  EXPECT_NE(error_with("mesh_folders", 7), "no error");
  EXPECT_NE(error_with("cloud", "yes"), "no error");
  EXPECT_NE(error_with("cloud/resolution", 0.0), "no error");
  EXPECT_NE(error_with("cloud/decay", -1.0), "no error");
  EXPECT_NE(error_with("cloud/colour", "red"), "no error");
  EXPECT_NE(error_with("cloud/box/min", 1.0), "no error");
  EXPECT_NE(error_with("cloud/box/middle", 1.0), "no error");
  XmlRpc::XmlRpcValue box;
  for (int i = 0; i < 3; ++i) {
    box["min"][i] = 1.0;
    box["max"][i] = 0.5 + i;
  }
  EXPECT_NE(error_with("cloud/box", box), "no error");
  EXPECT_NE(error_with("robot_timeout", 0.0), "no error");
  EXPECT_NE(error_with("obstacle_timeout", -1.0), "no error");
  XmlRpc::XmlRpcValue topic;
  topic["topic"] = "bodies";
  topic["type"] = "std_msgs/String";
  EXPECT_NE(error_with("obstacle_markers", topic), "no error");
  EXPECT_NE(error_with("obstacle_markers", ""), "no error");
  own.deleteParam("");
  own.setParam("mesh_folders", std::vector<std::string>{"/no/such/folder"});
  EXPECT_NE(error_of([&] { options(); }).find("'/no/such/folder'"), std::string::npos);
  own.deleteParam("");
  own.setParam("scene", "/no/such/scene.yaml");
  EXPECT_NE(error_of([&] { options(); }).find("'/no/such/scene.yaml'"), std::string::npos);
}

}  // namespace
}  // namespace environment_test
