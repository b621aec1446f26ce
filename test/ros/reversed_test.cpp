// A tracker that turns the order of a fibre's points round from frame to frame.
#include <algorithm>
#include <map>
#include <tuple>

#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

namespace {

using fiber_proximity::Contact;
using fiber_proximity::ContactArray;
using fiber_proximity::FiberArray;
using fiber_proximity_ros::to_vector;

class ReversedTest : public node_test::NodeTest {};

FiberArray reversed(FiberArray message) {
  for (std::size_t fiber = 0; fiber + 1 < message.offsets.size(); ++fiber) {
    std::reverse(message.points.begin() + message.offsets[fiber],
                 message.points.begin() + message.offsets[fiber + 1]);
  }
  return message;
}

/// A contact as a segment pair of the fibres in their first order, with the smaller one in front.
struct Pair {
  std::tuple<std::uint32_t, std::uint32_t> a, b;
  double distance = 0.0;
  Eigen::Vector3d point_a, point_b, normal;
};

std::vector<Pair> pairs_of(const ContactArray& answer, const FiberArray& fibers, bool is_reversed) {
  std::vector<Pair> pairs;
  for (const Contact& contact : answer.contacts) {
    const auto body = [&](std::uint32_t fiber, std::uint32_t segment) {
      const std::uint32_t segments = fibers.offsets[fiber + 1] - fibers.offsets[fiber] - 1;
      return std::make_tuple(fiber, is_reversed ? segments - 1 - segment : segment);
    };
    Pair pair{body(contact.fiber_a, contact.segment_a),
              body(contact.fiber_b, contact.segment_b),
              contact.distance,
              to_vector(contact.point_a),
              to_vector(contact.point_b),
              to_vector(contact.normal)};
    if (pair.b < pair.a) {
      std::swap(pair.a, pair.b);
      pair.point_a.swap(pair.point_b);
      pair.normal = -pair.normal;
    }
    pairs.push_back(pair);
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const Pair& p, const Pair& q) { return std::tie(p.a, p.b) < std::tie(q.a, q.b); });
  return pairs;
}

TEST_F(ReversedTest, AnswersAreTheSameWithTheIndicesCountedFromTheOtherEnd) {
  constexpr double rounding = 1e-9;
  fiber::test::Random random(17);
  FiberArray message = test_messages::tangled_fibers(random);
  const ros::Publisher publisher = advertise<FiberArray>("fibers");
  connect(publisher, message);
  for (int frame = 0; frame < 10; ++frame) {
    for (geometry_msgs::Point& point : message.points) {
      point.x += 0.001 * (frame % 2 == 0 ? 1.0 : -1.0);  // within the skin
    }
    std::vector<std::vector<Pair>> found;
    for (const bool is_reversed : {false, true}) {
      FiberArray sent = is_reversed ? reversed(message) : message;
      sent.header.stamp = new_stamp();
      publisher.publish(sent);
      const ContactArray* answer = contacts.wait_for(sent.header.stamp);
      const FiberArray* merged = fibers.wait_for(sent.header.stamp);
      ASSERT_NE(answer, nullptr);
      ASSERT_NE(merged, nullptr);
      node_test::expect_brute_force(*answer, *merged);
      found.push_back(pairs_of(*answer, sent, is_reversed));
    }
    ASSERT_GT(found[0].size(), 10U);
    ASSERT_EQ(found[0].size(), found[1].size());
    for (std::size_t i = 0; i < found[0].size(); ++i) {
      const Pair& p = found[0][i];
      const Pair& q = found[1][i];
      EXPECT_EQ(p.a, q.a);
      EXPECT_EQ(p.b, q.b);
      EXPECT_NEAR(p.distance, q.distance, rounding);
      EXPECT_LT((p.point_a - q.point_a).norm(), rounding);
      EXPECT_LT((p.point_b - q.point_b).norm(), rounding);
      EXPECT_LT((p.normal - q.normal).norm(), rounding);
    }
  }
}

}  // namespace
