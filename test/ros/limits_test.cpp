// Messages in which nearly all is in contact: the node answers within its limits, says so, and goes
// on.
#include "fiber_proximity/CheckFibers.h"
#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"
#include "test/support/answers.hpp"
#include "test/support/random.hpp"

namespace {

using Eigen::Vector3d;
using fiber_proximity::CheckFibers;
using fiber_proximity::ContactArray;

constexpr std::size_t contact_limit = 1000;  // as limits.test has it

class LimitsTest : public node_test::NodeTest {
 protected:
  void SetUp() override {
    connect(cloud_, test_messages::point_cloud2(test_messages::header("world"), few_points()));
  }

  /// That touch nothing.
  static std::vector<Vector3d> few_points() { return {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}; }

  /// In which nearly all is in contact.
  static std::vector<Vector3d> tangle(int count) {
    fiber::test::Random random;
    std::vector<Vector3d> points;
    for (int i = 0; i < count; ++i) {
      points.push_back(0.1 * random.in_cube());
    }
    return points;
  }

  const ContactArray* answer_about(const std::vector<Vector3d>& points) {
    const ros::Time stamp = new_stamp();
    cloud_.publish(test_messages::point_cloud2(test_messages::header("world", stamp), points));
    return contacts.wait_for(stamp);
  }

  ros::Publisher cloud_ = advertise<sensor_msgs::PointCloud2>("/cloud");
};

TEST_F(LimitsTest, ATangleIsAnsweredAndTheNextMessageToo) {
  const ContactArray* answer = answer_about(tangle(30'000));
  ASSERT_NE(answer, nullptr);
  EXPECT_EQ(answer->contacts.size(), contact_limit);
  EXPECT_TRUE(answer->limit_reached);
  EXPECT_FALSE(answer->complete);
  ASSERT_TRUE(answer->has_minimum);
  EXPECT_LE(answer->minimum_lower, answer->minimum_distance);
  expect_log("the closest 1000 are reported, as contact_limit says");
  EXPECT_FALSE(logs_of("as pair_limit says").empty());

  fiber_proximity::QueryProximity query;
  query.request.type = fiber_proximity::QueryProximity::Request::ALL;
  query.request.shapes.resize(2);
  for (fiber_proximity::QueryShape& shape : query.request.shapes) {
    shape.points.resize(1);
    shape.radius = 1.0;
  }
  ASSERT_TRUE(node_test::call_service("/proximity/query", query));
  ASSERT_TRUE(query.response.success) << query.response.message;
  EXPECT_TRUE(query.response.limit_reached);
  EXPECT_EQ(query.response.contacts.size(), contact_limit + 1);  // and the second shape's closest

  const ContactArray* next = answer_about(few_points());
  ASSERT_NE(next, nullptr);
  EXPECT_TRUE(next->contacts.empty());
  EXPECT_FALSE(next->limit_reached);
  EXPECT_TRUE(next->complete);
}

TEST_F(LimitsTest, OfTooManyContactsTheClosestAreReported) {
  const ContactArray* answer = answer_about(tangle(200));
  ASSERT_NE(answer, nullptr);
  const fiber_proximity::FiberArray* sent = fibers.wait_for(answer->header.stamp);
  ASSERT_NE(sent, nullptr);
  std::vector<fiber::Contact> expected =
      fiber::test::brute_force(node_test::to_assembly(*sent)).contacts;
  ASSERT_GT(expected.size(), 2 * contact_limit);
  fiber::sort_by_distance(expected);
  expected.resize(contact_limit);
  fiber::sort_by_key(expected);
  ASSERT_EQ(answer->contacts.size(), contact_limit);
  for (std::size_t i = 0; i < contact_limit; ++i) {
    node_test::expect_same(answer->contacts[i], expected[i]);
  }
  EXPECT_TRUE(answer->limit_reached);
  EXPECT_TRUE(answer->complete);
}

// In two blocks, of which the first is full and leaves little to the second.
TEST_F(LimitsTest, ManyCandidatesShareTheLimitOfContacts) {
  constexpr std::size_t count = 260;
  const std::vector<Vector3d> points = tangle(50);
  ASSERT_NE(answer_about(points), nullptr);
  CheckFibers check;
  check.request.type = CheckFibers::Request::ALL;
  check.request.candidates.assign(
      count, test_messages::fiber_array(test_messages::header("world"), points));
  for (fiber_proximity::FiberArray& candidate : check.request.candidates) {
    candidate.radii = {0.01};
  }
  ASSERT_TRUE(node_test::call_service("/proximity/check_fibers", check));
  ASSERT_TRUE(check.response.success) << check.response.message;
  EXPECT_EQ(check.response.free, std::vector<std::uint8_t>(count, 0));
  EXPECT_TRUE(check.response.limit_reached);
  EXPECT_LE(check.response.contacts.size(), contact_limit);
  EXPECT_GT(check.response.contacts.size(), contact_limit / 2) << "or too little is left out";
}

}  // namespace
