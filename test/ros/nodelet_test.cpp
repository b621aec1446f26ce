// The nodelet in a manager, by the name that the README has.
#include <nodelet/NodeletLoad.h>

#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

namespace {

class NodeletTest : public node_test::NodeTest {
 protected:
  static bool load(const std::string& name) {
    nodelet::NodeletLoad load;
    load.request.name = name;
    load.request.type = "fiber_proximity/proximity";
    EXPECT_TRUE(ros::service::waitForService("/manager/load_nodelet", ros::Duration(30.0)));
    return ros::service::call("/manager/load_nodelet", load) && load.response.success;
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

}  // namespace
