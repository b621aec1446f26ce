// The running node with latency_compensation: bounds have room for how far the fibres of an input,
// whose points are known to 1 mm, may have moved since their stamps.
#include "test/ros/messages.hpp"
#include "test/ros/simulated_time_test.hpp"

namespace {

using fiber_proximity::FiberArray;
using fiber_proximity::QueryProximity;
using test_messages::fiber_array;
using test_messages::header;

constexpr double uncertainty = 0.001;  // [m] of tracked points
constexpr double radius = 0.01;        // [m]
constexpr double tiny = 1e-9;          // [m] more than the roundings of stamps

class LatencyNodeTest : public node_test::SimulatedTimeTest {
 protected:
  /// A cable of so many points along x at this y, with a stamp of now.
  void send(double y, int points = 2) {
    FiberArray message = fiber_array(header("world"), {});
    for (int i = 0; i < points; ++i) {
      message.points.push_back(fiber_proximity_ros::to_message(Eigen::Vector3d(i, y, 0.0)));
    }
    message.offsets = {0, static_cast<std::uint32_t>(points)};
    message.radii = {radius};
    stamp_ = message.header.stamp = now();
    tracked_.publish(message);
    told_ = y - radius;
  }

  /// What is known of the distance of the cable to the x axis, by an answer about this message.
  QueryProximity::Response query() {
    QueryProximity query;
    query.request.type = QueryProximity::Request::CLOSEST;
    query.request.margin = 10.0;
    query.request.shapes.resize(1);
    query.request.shapes[0].points.resize(1);
    EXPECT_TRUE(node_test::call_service("/proximity/query", query));
    return query.response;
  }

  /// Waits until answers are about the newest message, the time is now, and the bounds are so wide.
  void expect(double by) {
    QueryProximity::Response answer;
    EXPECT_TRUE(node_test::wait_for([&] {
      answer = query();
      return answer.success && answer.header.stamp == stamp_ && answer.contacts.size() == 1 &&
             answer.complete != 0 && std::abs(answer.contacts[0].lower - (told_ - by)) < tiny;
    })) << "not "
        << by;
    ASSERT_EQ(answer.contacts.size(), 1U);
    EXPECT_NEAR(answer.contacts[0].distance, told_, tiny);
    EXPECT_NEAR(answer.contacts[0].upper, told_ + by, tiny);
    EXPECT_NEAR(answer.minimum_lower[0], told_ - by, tiny);
  }

  /// Waits until answers are about the newest message, and incomplete as its speed is not known.
  void expect_unknown() {
    QueryProximity::Response answer;
    EXPECT_TRUE(node_test::wait_for([&] {
      answer = query();
      return answer.success && answer.header.stamp == stamp_;
    }));
    EXPECT_FALSE(answer.complete);
    ASSERT_EQ(answer.unknown.size(), 1U);
    EXPECT_NE(answer.unknown[0].find("how fast its fibres move is not known"), std::string::npos)
        << answer.unknown[0];
    EXPECT_LT(answer.minimum_lower[0], -1e300);
  }

  ros::Publisher tracked_ = advertise<FiberArray>("/tracked");
  ros::Time stamp_;
  double told_ = 0.0;  // [m]
};

TEST_F(LatencyNodeTest, BoundsGrowWithAgeTimesSpeed) {
  send(1.0);
  expect_unknown();
  pass(0.1);
  send(0.98);  // 0.2 m/s
  expect(uncertainty);
  pass(0.25);
  expect(uncertainty + 0.2 * 0.25);
  pass(0.75);
  expect(uncertainty + 0.2 * 1.0);
  send(0.93);  // 0.05 m/s, in one second
  expect(uncertainty);
  pass(0.5);
  expect(uncertainty + 0.05 * 0.5);
  send(0.93, 3);
  expect_unknown();
  pass(0.5);
  expect_unknown();
  send(0.93, 3);
  pass(2.0);
  expect(uncertainty);
}

}  // namespace
