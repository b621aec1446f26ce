// EnvironmentInputs through the real graph: allowed pairs, scene, robot, parameters.
#include "src/ros/environment/environment_inputs.hpp"

#include <algorithm>

#include "test/ros/environment_fixture.hpp"

namespace environment_test {
namespace {

using fiber::test::error_of;

TEST_F(EnvironmentInputsTest, NothingIsSubscribedToUnlessItIsConfigured) {
  start();
  EXPECT_FALSE(inputs->is_used());
  EXPECT_EQ(inputs->statistics(ros::Time::now()).front().topic, own.resolveName("obstacles"));
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

TEST_F(EnvironmentInputsTest, UpdateTellsThatAServiceHasChangedSomething) {
  start();
  EXPECT_FALSE(inputs->update(ros::Time::now()));
  EXPECT_EQ(apply({ball("a")}), "");
  EXPECT_TRUE(inputs->update(ros::Time::now()));
  EXPECT_FALSE(inputs->update(ros::Time::now()));
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
  ASSERT_EQ(unknown().size(), 1U);
  EXPECT_EQ(unknown()[0].rfind("shelf: obstacle 'shelf': no transform from frame 'wall'", 0), 0U);
  static_transforms.sendTransform(transform("wall", 3.0));
  ASSERT_TRUE(wait_for([&] { return unknown().empty(); }));
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
  ASSERT_EQ(unknown().size(), 1U);
  EXPECT_EQ(unknown()[0].rfind("robot/hand: no transform from frame 'hand'", 0), 0U);
  EXPECT_EQ(places().size(), 1U);
  move("hand", 2.0);
  EXPECT_TRUE(unknown().empty());
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
    send(0.0);  // one that is sent while the listener connects may be lost
    send(0.5);
    return place_at(0.0) == 0.0 && place_at(0.5) == 0.5;
  }));
  EXPECT_NEAR(place_at(0.25), 0.25, 1e-6);
  EXPECT_EQ(place_at(0.75), 0.5);  // not known yet: the latest
  EXPECT_EQ(place_at(2.0), -1.0);  // too old for that
}

/// What a refused change was to bring is not there after another one that brings something else.
TEST_F(EnvironmentInputsTest, WhatIsOwedIsSettledByWhatMakesItKnown) {
  start();
  const auto changed = [](Obstacle obstacle, std::uint8_t operation, const std::string& from) {
    obstacle.operation = operation;
    obstacle.header.frame_id = from;
    return obstacle;
  };
  const auto move_in = [&](const std::string& from) {
    Obstacle move;
    move.id = "ball";
    move.pose.orientation.w = 1.0;
    return changed(move, Obstacle::MOVE, from);
  };
  const auto owes = [&] { return unknown().size(); };
  EXPECT_EQ(apply({ball("ball")}), "");
  EXPECT_EQ(owes(), 0U);
  // A place is known again by the next one.
  EXPECT_NE(apply({move_in("nowhere")}), "");
  EXPECT_EQ(owes(), 1U);
  EXPECT_EQ(apply({changed(ball("ball"), Obstacle::APPEND, "world")}), "");
  EXPECT_EQ(owes(), 1U);
  EXPECT_EQ(apply({move_in("world")}), "");
  EXPECT_EQ(owes(), 0U);
  // Shapes are not.
  for (const std::uint8_t refused : {Obstacle::ADD, Obstacle::APPEND}) {
    EXPECT_NE(apply({changed(ball("ball"), refused, "nowhere")}), "");
    EXPECT_NE(apply({move_in("nowhere")}), "");
    EXPECT_EQ(apply({move_in("world")}), "");
    EXPECT_EQ(owes(), 1U);
    EXPECT_EQ(apply({changed(ball("ball"), Obstacle::APPEND, "world")}), "");
    EXPECT_EQ(owes(), 1U);
    EXPECT_EQ(apply({ball("ball")}), "");
    EXPECT_EQ(owes(), 0U);
  }
  EXPECT_NE(apply({changed(ball("ball"), Obstacle::APPEND, "nowhere")}), "");
  EXPECT_EQ(apply({removal("ball")}), "");
  EXPECT_EQ(owes(), 0U);
}

TEST_F(EnvironmentInputsTest, BadParametersAreRefusedByName) {
  const auto error_with = [&](const std::string& name, const XmlRpc::XmlRpcValue& value) {
    own.deleteParam("");
    own.setParam(name, value);
    std::string error = error_of([&] { options(); });
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
