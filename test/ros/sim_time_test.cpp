// Simulated time: it stands still, runs, and starts again.
#include <rosgraph_msgs/Clock.h>

#include <optional>

#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

namespace {

using fiber_proximity::ContactArray;
using fiber_proximity::FiberArray;
using test_messages::header;

class SimTimeTest : public node_test::NodeTest {
 protected:
  /// Keeps the time at this value until there is an answer that meets the condition, sending the
  /// fibres meanwhile if there are any to send.
  const ContactArray* wait_at(double seconds, const std::optional<FiberArray>& sent,
                              const std::function<bool(const ContactArray&)>& condition) {
    rosgraph_msgs::Clock time;
    time.clock = ros::Time(seconds);
    const ContactArray* found = nullptr;
    ros::SteadyTime last;
    node_test::wait_for([&] {
      if ((ros::SteadyTime::now() - last).toSec() > 0.05) {
        last = ros::SteadyTime::now();
        clock_.publish(time);
        if (sent) {
          fibers_publisher_.publish(*sent);
        }
      }
      return (found = contacts.find(condition)) != nullptr;
    });
    return found;
  }

  ros::Publisher clock_ = advertise<rosgraph_msgs::Clock>("/clock");
  ros::Publisher fibers_publisher_ = advertise<FiberArray>("fibers");
};

TEST_F(SimTimeTest, FibresAgeInItAndAreForgottenWhenItStartsAgain) {
  const auto array = [](double stamp) {
    return test_messages::fiber_array(header("map", ros::Time(stamp)),
                                      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  };
  const auto has_stamp = [](double seconds, bool empty) {
    return [seconds, empty](const ContactArray& message) {
      return message.header.stamp == ros::Time(seconds) && message.fiber_names.empty() == empty;
    };
  };
  // Without a stamp an answer has the node's time.
  const ContactArray* answer = wait_at(100.0, array(0.0), has_stamp(100.0, false));
  ASSERT_NE(answer, nullptr);
  EXPECT_EQ(answer->header.frame_id, "map") << "the first message's frame";

  ASSERT_NE(wait_at(111.0, {}, has_stamp(111.0, true)), nullptr) << "fibres do not age";
  ASSERT_NE(wait_at(111.0, array(110.5), has_stamp(110.5, false)), nullptr);

  ASSERT_NE(wait_at(5.0, {}, has_stamp(5.0, true)), nullptr) << "fibres of the future are kept";
  EXPECT_NE(wait_at(5.0, array(4.5), has_stamp(4.5, false)), nullptr);
}

}  // namespace
