// The shipped settings for trackers, with nothing set about neighbours: cables touch themselves
// only where they make a loop.
#include "ros/messages.hpp"
#include "ros/node_test.hpp"
#include "support/random.hpp"

namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

constexpr int count = 45;

class SelfContactTest : public node_test::NodeTest {
 protected:
  /// Of an answer about both clouds.
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

  static Points line(double length, const Vector3d& from) {
    Points points;
    for (int i = 0; i < count; ++i) {
      points.push_back(from + length * i / (count - 1) * Vector3d(0.6, 0.8, 0.0));
    }
    return points;
  }

  /// Strands of ten radii each, which touch.
  static Points hairpin(double radius, const Vector3d& from) {
    Points points;
    for (int i = 0; i <= 20; ++i) {
      points.push_back(from + radius * Vector3d(0.5 * i, 0.0, 0.0));
    }
    for (int i = 20; i >= 0; --i) {
      points.push_back(from + radius * Vector3d(0.5 * i, 1.999, 0.0));
    }
    return points;
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
    const fiber_proximity::ContactArray* answer = answer_about(
        line(length, Vector3d(0.0, 0.0, height)), line(length, Vector3d(0.5, 0.0, height)));
    ASSERT_NE(answer, nullptr);
    EXPECT_EQ(answer->contacts.size(), 0U);
    ASSERT_TRUE(answer->has_minimum);
    EXPECT_NE(answer->minimum.fiber_a, answer->minimum.fiber_b);
  }
  const fiber_proximity::ContactArray* answer =
      answer_about(hairpin(0.004, Vector3d(0.0, 0.0, 1.0)), line(0.6, Vector3d(0.5, 0.0, 1.0)));
  ASSERT_NE(answer, nullptr);
  ASSERT_FALSE(answer->contacts.empty());
  for (const fiber_proximity::Contact& contact : answer->contacts) {
    EXPECT_EQ(contact.fiber_a, contact.fiber_b);
  }
  EXPECT_LT(answer->minimum_distance, 0.0);
}

}  // namespace
