// The nodelet in a manager, by the name that the README has.
#include <nodelet/NodeletLoad.h>
#include <nodelet/NodeletUnload.h>
#include <ros/package.h>

#include <atomic>
#include <thread>

#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

namespace {

class NodeletTest : public node_test::NodeTest {
 protected:
  static bool load(const std::string& name, const std::string& type = "proximity") {
    nodelet::NodeletLoad load;
    load.request.name = name;
    load.request.type = "fiber_proximity/" + type;
    EXPECT_TRUE(
        ros::service::waitForService("/manager/load_nodelet", ros::Duration(node_test::patience)));
    return node_test::call_service_alone("/manager/load_nodelet", load) && load.response.success;
  }

  static bool unload(const std::string& name) {
    nodelet::NodeletUnload unload;
    unload.request.name = name;
    return node_test::call_service_alone("/manager/unload_nodelet", unload) &&
           unload.response.success;
  }

  /// A nodelet whose one input is on this topic.
  static void set_input(const std::string& name, const std::string& topic) {
    XmlRpc::XmlRpcValue inputs;
    inputs[0]["topic"] = topic;
    ros::param::set(name + "/inputs", inputs);
    ros::param::set(name + "/fixed_frame", "world");
  }

  std::vector<std::string> fatal_logs_of(const std::string& what) const {
    std::vector<std::string> found;
    for (const auto& log : logs.messages) {
      if (log->level == rosgraph_msgs::Log::FATAL && log->name == "/manager" &&
          log->msg.find(what) != std::string::npos) {
        found.push_back(log->msg);
      }
    }
    return found;
  }
};

TEST_F(NodeletTest, TheManagersLogSaysWhyOneDoesNotLoad) {
  ros::param::set("/proximity/margin", -1);
  ASSERT_TRUE(node_test::wait_for([this] {
    EXPECT_FALSE(load("/proximity"));
    return !fatal_logs_of("parameter /proximity/margin").empty();
  }));
  EXPECT_EQ(fatal_logs_of("parameter /proximity/margin").front(),
            "nodelet /proximity: parameter /proximity/margin is -1, it must be a number of at "
            "least 0");
  ros::param::set("/proximity/margin", 0.1);
  ros::param::set("/proximity/engine", "nonsense");
  EXPECT_FALSE(load("/proximity"));
  EXPECT_TRUE(node_test::wait_for([this] {
    return !fatal_logs_of("parameter /proximity/engine: unknown engine 'nonsense'").empty();
  }));
  // The manager lives on, and loads it when it can.
  ros::param::del("/proximity/engine");
  ASSERT_TRUE(load("/proximity"));
  const ros::Publisher publisher = advertise<fiber_proximity::FiberArray>("fibers");
  connect(publisher, test_messages::fiber_array(test_messages::header("world"),
                                                {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
  EXPECT_EQ(contacts.messages.back()->margin, 0.1);
}

// Messages of the topic are there while they are built, and while they end.
TEST_F(NodeletTest, TwoOnABusyTopicAreLoadedAndUnloadedAgainAndAgain) {
  std::atomic<bool> ends{false};
  std::thread tracker([&ends] {
    ros::NodeHandle own;
    const ros::Publisher publisher = own.advertise<fiber_proximity::FiberArray>("/busy", 10);
    while (!ends) {
      publisher.publish(test_messages::fiber_array(test_messages::header("world", ros::Time::now()),
                                                   {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
      ros::WallDuration(0.01).sleep();
    }
  });
  for (const char* const name : {"/first", "/second"}) {
    set_input(name, "/busy");
  }
  node_test::Recorder<fiber_proximity::ContactArray> answers(node, "/first/contacts");
  for (int i = 0; i < 50 && !HasFailure(); ++i) {
    EXPECT_TRUE(load("/first")) << i;
    EXPECT_TRUE(load("/second")) << i;
    if (i % 10 == 0) {
      answers.messages.clear();
      EXPECT_NE(answers.wait_for([](const auto& answer) { return !answer.fiber_names.empty(); }),
                nullptr);
    }
    EXPECT_TRUE(unload("/first")) << i;
    EXPECT_TRUE(unload("/second")) << i;
  }
  ends = true;
  tracker.join();
}

// One's output is the other's input, without a copy in between; it is latched, so that it is there
// at once.
TEST_F(NodeletTest, TheSimulatorAndTheNodeWorkInOneManager) {
  ros::param::set("/chained_sim/scene",
                  ros::package::getPath("fiber_proximity") + "/config/sim/hanging_cable.yaml");
  set_input("/chained", "/chained_sim/fibers");
  node_test::Recorder<fiber_proximity::ContactArray> answers(node, "/chained/contacts");
  ASSERT_TRUE(load("/chained_sim", "cable_sim"));
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(load("/chained"));
    answers.messages.clear();
    EXPECT_NE(answers.wait_for([](const auto& answer) { return !answer.fiber_names.empty(); }),
              nullptr);
    ASSERT_TRUE(unload("/chained"));
  }
  EXPECT_TRUE(unload("/chained_sim"));
}

}  // namespace
