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
    return wait_for([&] { set_time(seconds); }, sent, condition);
  }

  /// Lets the time run from this value, one second a tick, until there is such an answer.
  const ContactArray* wait_from(double seconds,
                                const std::function<bool(const ContactArray&)>& condition) {
    return wait_for([&] { set_time(seconds++); }, {}, condition);
  }

  /// [s] the time that was told last.
  double now() const { return now_; }

 private:
  const ContactArray* wait_for(const std::function<void()>& tick,
                               const std::optional<FiberArray>& sent,
                               const std::function<bool(const ContactArray&)>& condition) {
    const ContactArray* found = nullptr;
    ros::SteadyTime last;
    node_test::wait_for([&] {
      if ((ros::SteadyTime::now() - last).toSec() > 0.05) {
        last = ros::SteadyTime::now();
        tick();
        if (sent) {
          fibers_publisher_.publish(*sent);
        }
      }
      return (found = contacts.find(condition)) != nullptr;
    });
    return found;
  }

  void set_time(double seconds) {
    rosgraph_msgs::Clock time;
    time.clock = ros::Time(seconds);
    clock_.publish(time);
    now_ = seconds;
  }

  double now_ = 0.0;

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

  // Time runs: fibres without a stamp that were still on their way at 111 s are as young as that.
  const auto is_empty = [](const ContactArray& message) {
    return message.header.stamp >= ros::Time(111.0) && message.fiber_names.empty();
  };
  ASSERT_NE(wait_from(111.0, is_empty), nullptr) << "fibres do not age";
  ASSERT_NE(wait_at(now(), array(now() - 0.5), has_stamp(now() - 0.5, false)), nullptr);

  ASSERT_NE(wait_at(5.0, {}, has_stamp(5.0, true)), nullptr) << "fibres of the future are kept";
  EXPECT_NE(wait_at(5.0, array(4.5), has_stamp(4.5, false)), nullptr);
}

}  // namespace
