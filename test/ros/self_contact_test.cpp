// The shipped settings for trackers, with nothing set about neighbours: cables touch themselves
// only where they make a loop.
#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

constexpr int point_count = 45;

Points line(int points, double length, const Vector3d& from) {
  Points line;
  for (int i = 0; i < points; ++i) {
    line.push_back(from + length * i / (points - 1) * Vector3d(0.6, 0.8, 0.0));
  }
  return line;
}

/// Strands of ten radii each, which touch.
Points hairpin(double radius, const Vector3d& from) {
  Points points;
  for (int i = 0; i <= 20; ++i) {
    points.push_back(from + radius * Vector3d(0.5 * i, 0.0, 0.0));
  }
  for (int i = 20; i >= 0; --i) {
    points.push_back(from + radius * Vector3d(0.5 * i, 1.999, 0.0));
  }
  return points;
}

/// With config/trackdlo.yaml.
class SelfContactTest : public node_test::NodeTest {
 protected:
  /// Sends both clouds and returns the answer about them.
  const fiber_proximity::ContactArray* answer_about(const Points& left, const Points& right) {
    const ros::Time stamp = new_stamp();
    left_.publish(test_messages::point_cloud2(test_messages::header("world", stamp), left));
    right_.publish(test_messages::point_cloud2(test_messages::header("world", stamp), right));
    return contacts.wait_for([&](const fiber_proximity::ContactArray& answer) {
      const fiber_proximity::FiberArray* merged =
          fibers.find([&](const fiber_proximity::FiberArray& each) {
            return is_of(each, answer, left, right);
          });
      return merged != nullptr;
    });
  }

  ros::Publisher left_ = advertise<sensor_msgs::PointCloud2>("/cable_left/results_pc");
  ros::Publisher right_ = advertise<sensor_msgs::PointCloud2>("/cable_right/results_pc");

 private:
  static bool is_of(const fiber_proximity::FiberArray& merged,
                    const fiber_proximity::ContactArray& answer, const Points& left,
                    const Points& right) {
    // Cables that arrive one after the other have an answer each, of one stamp.
    return merged.header.stamp == answer.header.stamp && answer.fiber_names.size() == 2 &&
           merged.points.size() == left.size() + right.size() && is_at(merged, 0, left.front()) &&
           is_at(merged, left.size(), right.front());
  }

  /// Clouds are in single precision.
  static bool is_at(const fiber_proximity::FiberArray& merged, std::size_t i, const Vector3d& p) {
    return (fiber_proximity_ros::to_vector(merged.points[i]) - p).norm() < 1e-6;
  }
};

TEST_F(SelfContactTest, StraightCablesHaveNoneAndHairpinsDo) {
  double height = 0.0;
  for (const double length : {0.4, 0.5, 0.6, 0.7, 0.8}) {
    SCOPED_TRACE(length);
    height += 0.1;  // tells the answers apart
    const fiber_proximity::ContactArray* answer =
        answer_about(line(point_count, length, Vector3d(0.0, 0.0, height)),
                     line(point_count, length, Vector3d(0.5, 0.0, height)));
    ASSERT_NE(answer, nullptr);
    EXPECT_EQ(answer->contacts.size(), 0U);
    ASSERT_TRUE(answer->has_minimum);
    EXPECT_NE(answer->minimum.fiber_a, answer->minimum.fiber_b);
  }
  const fiber_proximity::ContactArray* answer = answer_about(
      hairpin(0.004, Vector3d(0.0, 0.0, 1.0)), line(point_count, 0.6, Vector3d(0.5, 0.0, 1.0)));
  ASSERT_NE(answer, nullptr);
  ASSERT_FALSE(answer->contacts.empty());
  for (const fiber_proximity::Contact& contact : answer->contacts) {
    EXPECT_EQ(contact.fiber_a, contact.fiber_b);
  }
  EXPECT_LT(answer->minimum_distance, 0.0);
}

/// With config/cdcpd.yaml.
class SelfContactOfOneTest : public node_test::NodeTest {
 protected:
  const fiber_proximity::ContactArray* answer_about(const Points& points) {
    const ros::Time stamp = new_stamp();
    rope_.publish(test_messages::point_cloud2(test_messages::header("world", stamp), points));
    return contacts.wait_for(stamp);
  }

  ros::Publisher rope_ = advertise<sensor_msgs::PointCloud2>("/cdcpd/output");
};

TEST_F(SelfContactOfOneTest, AStraightCableHasNoneAndAHairpinDoes) {
  connect(rope_, test_messages::point_cloud2(test_messages::header("world"),
                                             line(11, 0.5, Vector3d::Zero())));
  for (const int points : {11, 18, 25, point_count}) {
    for (const double length : {0.2, 0.4, 0.8}) {
      SCOPED_TRACE(testing::Message() << points << " points, " << length << " m");
      const fiber_proximity::ContactArray* answer =
          answer_about(line(points, length, Vector3d::Zero()));
      ASSERT_NE(answer, nullptr);
      EXPECT_EQ(answer->contacts.size(), 0U);
      EXPECT_FALSE(answer->has_minimum);
    }
  }
  const fiber_proximity::ContactArray* answer = answer_about(hairpin(0.01, Vector3d::Zero()));
  ASSERT_NE(answer, nullptr);
  EXPECT_FALSE(answer->contacts.empty());
  EXPECT_LT(answer->minimum_distance, 0.0);
}

}  // namespace
