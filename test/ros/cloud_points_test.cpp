// What the running node says about the points of clouds of which few or none are of use.

#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"
#include "test/support/not_finite.hpp"

namespace {

using fiber::test::nan;
using fiber_proximity::FiberArray;
using fiber_proximity::InputStatistics;
using test_messages::header;
using test_messages::Points;

class CloudPointsTest : public node_test::NodeTest {
 protected:
  void SetUp() override { connect(fibers_publisher_, fiber()); }

  static FiberArray fiber() {
    return test_messages::fiber_array(header("world", new_stamp()), {{0, 0, 0}, {1, 0, 0}});
  }

  /// Returns what the node tells about a cloud once it has become of use, or has not.
  InputStatistics told_about(const Points& points) {
    cloud_.publish(test_messages::point_cloud2(header("world"), points));
    InputStatistics told;
    EXPECT_TRUE(node_test::wait_for([&] {
      const FiberArray message = fiber();
      fibers_publisher_.publish(message);
      const fiber_proximity::Statistics* now = statistics.wait_for(message.header.stamp);
      if (now == nullptr) {
        return true;
      }
      told = *input_of(*now, "/proximity/cloud");
      return told.points_received == points.size();
    }));
    return told;
  }

  ros::Publisher fibers_publisher_ = advertise<FiberArray>("fibers");
  ros::Publisher cloud_ = advertise<sensor_msgs::PointCloud2>("/proximity/cloud");
};

TEST_F(CloudPointsTest, EachIsAccountedFor) {
  const InputStatistics told = told_about(
      {{0, 0, 1}, {0, 0, 1}, {nan, 0, 1}, {0, 0, 3}, {0, 1e30, 1}, {700, 0, 1}, {0, 700, 1}});
  EXPECT_EQ(told.received, 1U);
  EXPECT_EQ(told.points_received, 7U);
  EXPECT_EQ(told.points_used, 2U);
  EXPECT_EQ(told.points_not_finite, 1U);
  EXPECT_EQ(told.points_outside_box, 1U);
  EXPECT_EQ(told.points_too_far, 3U);
  EXPECT_TRUE(logs_of("none of its").empty());
}

TEST_F(CloudPointsTest, ACloudOfWhichNoneIsUsedIsAWarning) {
  // In millimetres, beyond all numbers of cells, without a point.
  const InputStatistics told = told_about({{0, 900, 1}, {1e30, 0, 1}, {nan, nan, nan}});
  EXPECT_EQ(told.points_used, 0U);
  ASSERT_TRUE(node_test::wait_for([this] { return !logs_of("none of its").empty(); }));
  EXPECT_EQ(logs_of("none of its").front(),
            "'/proximity/cloud' (sensor_msgs/PointCloud2): none of its 3 point(s) is used: 1 is "
            "not finite, 2 are further than 655.36 m "
            "from the origin of the fixed frame along an axis (is the unit metres?)");
  EXPECT_EQ(told_about({{0, 0, 1}}).points_used, 1U);
}

}  // namespace
