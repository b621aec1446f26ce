#pragma once

#include <rosgraph_msgs/Clock.h>

#include "test/ros/node_test.hpp"

namespace node_test {

/// Where time passes when the test says so, however busy the machine is. Its launch file sets
/// use_sim_time.
class SimulatedTimeTest : public NodeTest {
 protected:
  SimulatedTimeTest() { pass(0.05); }

  /// Lets time pass, and the node deal with what it was sent before.
  void pass(double seconds) {
    now() += ros::Duration(seconds);
    rosgraph_msgs::Clock clock;
    clock.clock = now();
    clock_.publish(clock);
    ask();
  }

  /// What the node answers to a query without shapes, once it has dealt with what it was sent
  /// before.
  static fiber_proximity::QueryProximity::Response ask() {
    fiber_proximity::QueryProximity query;
    EXPECT_TRUE(call_service("/proximity/query", query));
    return query.response;
  }

  /// Simulated; goes on from test to test.
  static ros::Time& now() {
    static ros::Time time(1000.0);
    return time;
  }

 private:
  ros::Publisher clock_ = node.advertise<rosgraph_msgs::Clock>("/clock", 1000, true);
};

}  // namespace node_test
