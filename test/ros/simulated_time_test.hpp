#pragma once

#include <rosgraph_msgs/Clock.h>

#include "test/ros/node_test.hpp"

namespace node_test {

/// Where time passes when the test says so, however busy the machine is. Its launch file sets
/// use_sim_time.
class SimulatedTimeTest : public NodeTest {
 protected:
  SimulatedTimeTest() { pass(0.05); }

  /// Lets time pass, and the node deal with what it was sent before. The node hears of the time by
  /// itself, up to 40 ms late: TCP holds small messages back until those before are acknowledged.
  void pass(double seconds) {
    now() += ros::Duration(seconds);
    rosgraph_msgs::Clock clock;
    clock.clock = now();
    clock_publisher().publish(clock);
    EXPECT_TRUE(wait_for([] {
      return ask(fiber_proximity::QueryProximity::Request::ENVIRONMENT).header.stamp >= now();
    })) << "the node does not hear of the time";
  }

  /// What the node answers to a query without shapes, once it has dealt with what it was sent
  /// before.
  static fiber_proximity::QueryProximity::Response ask(
      std::uint8_t against = fiber_proximity::QueryProximity::Request::FIBERS) {
    fiber_proximity::QueryProximity query;
    query.request.against = against;
    EXPECT_TRUE(call_service("/proximity/query", query));
    return query.response;
  }

  /// Simulated; goes on from test to test.
  static ros::Time& now() {
    static ros::Time time(1000.0);
    return time;
  }

 private:
  /// One for all tests: until a node has heard of a new one, time would go on without it. Never
  /// taken apart: ROS has ended by then.
  static ros::Publisher& clock_publisher() {
    static auto& publisher = *new ros::Publisher(
        ros::NodeHandle().advertise<rosgraph_msgs::Clock>("/clock", 1000, true));
    return publisher;
  }
};

}  // namespace node_test
