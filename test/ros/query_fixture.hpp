#pragma once

#include <iostream>
#include <string>

#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"
#include "test/support/answers.hpp"

namespace node_test {

/// Asks ~query about random fibres.
class QueryTest : public NodeTest {
 protected:
  static fiber_proximity::QueryShape shape(const std::string& frame,
                                           const test_messages::Points& points, double radius) {
    fiber_proximity::QueryShape shape;
    shape.header.frame_id = frame;
    shape.radius = radius;
    for (const Eigen::Vector3d& point : points) {
      shape.points.push_back(fiber_proximity_ros::to_message(point));
    }
    return shape;
  }

  static fiber_proximity::QueryProximity::Response call(
      const fiber_proximity::QueryProximity::Request& request) {
    fiber_proximity::QueryProximity query;
    query.request = request;
    EXPECT_TRUE(call_service("/proximity/query", query));
    return query.response;
  }

  /// Sends random fibres and keeps what the node made of them.
  void send_fibers() {
    std::cout << fiber::test::seed_message() << '\n';
    fiber::test::Random random;
    test_messages::Points points(40);
    for (Eigen::Vector3d& point : points) {
      point = random.in_cube();
    }
    fiber_proximity::FiberArray message =
        test_messages::fiber_array(test_messages::header("world"), points);
    message.offsets = {0, 10, 25, 40};
    publisher_ = advertise<fiber_proximity::FiberArray>("fibers");
    connect(publisher_, message);
    stamp_ = new_stamp();
    message.header.stamp = stamp_;
    publisher_.publish(message);
    const fiber_proximity::FiberArray* merged = fibers.wait_for(stamp_);
    ASSERT_NE(merged, nullptr);
    assembly_ = to_assembly(*merged);
  }

  /// Compares the answer about one shape with brute force.
  void expect_brute_force(const fiber_proximity::QueryProximity::Response& response,
                          std::uint32_t index, const test_messages::Points& points, double radius,
                          const fiber::QueryOptions& options) const {
    const fiber::FiberAssembly shape(points, {0, static_cast<std::uint32_t>(points.size())},
                                     {radius});
    const fiber::QueryResult expected = fiber::test::brute_force(shape, assembly_, options);
    const std::uint32_t begin = response.offsets[index];
    ASSERT_EQ(response.offsets[index + 1] - begin, expected.contacts.size());
    for (std::size_t i = 0; i < expected.contacts.size(); ++i) {
      const fiber_proximity::Contact& contact = response.contacts[begin + i];
      const fiber::Contact& wanted = expected.contacts[i];
      EXPECT_EQ(contact.type_a, fiber_proximity::Contact::SHAPE);
      EXPECT_EQ(contact.fiber_a, index);
      EXPECT_EQ(contact.segment_a, wanted.segment_a);
      EXPECT_EQ(contact.fiber_b, wanted.fiber_b);
      EXPECT_EQ(contact.segment_b, wanted.segment_b);
      EXPECT_NEAR(contact.distance, wanted.distance, 1e-12);
      EXPECT_LT((fiber_proximity_ros::to_vector(contact.point_b) - wanted.point_b).norm(), 1e-9);
    }
  }

  ros::Publisher publisher_;
  ros::Time stamp_;
  fiber::FiberAssembly assembly_;
};

}  // namespace node_test
