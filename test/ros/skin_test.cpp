// The running node with ~skin: candidates serve several messages, answers stay exact.
#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"
#include "test/support/random.hpp"

namespace {

using fiber::test::Random;
using fiber_proximity::FiberArray;

constexpr double skin = 0.04;      // [m] as in skin.test
constexpr double motion = 0.0045;  // [m] of every point from message to message

using SkinTest = node_test::NodeTest;

TEST_F(SkinTest, LooksForCandidatesOnlyWhenFibersHaveMovedFar) {
  SCOPED_TRACE(fiber::test::seed_message());
  Random random;
  FiberArray message = test_messages::tangled_fibers(random);
  std::vector<Eigen::Vector3d> velocities;  // [m] per message
  for (std::size_t i = 0; i < message.points.size(); ++i) {
    velocities.push_back(motion * random.direction());
  }
  const ros::Publisher publisher = advertise<FiberArray>("fibers");
  connect(publisher, test_messages::fiber_array(test_messages::header("world"),
                                                {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
  const int lasts = static_cast<int>(0.5 * skin / motion);  // two points may approach each other
  for (int frame = 0; frame < 3 * (lasts + 1); ++frame) {
    SCOPED_TRACE(frame);
    message.header.stamp = new_stamp();
    publisher.publish(message);
    const fiber_proximity::ContactArray* answer = contacts.wait_for(message.header.stamp);
    const FiberArray* merged = fibers.wait_for(message.header.stamp);
    ASSERT_NE(answer, nullptr);
    ASSERT_NE(merged, nullptr);
    fiber::QueryOptions options;
    options.neighbour_skip = 1;
    node_test::expect_brute_force(*answer, *merged, options);
    // Segments two apart on a fibre are nearer than the margin; without any, the closest pair would
    // be looked for.
    ASSERT_FALSE(answer->contacts.empty());
    if (frame % (lasts + 1) == 0) {
      EXPECT_GT(answer->node_tests, 0U);
    } else {
      EXPECT_EQ(answer->node_tests, 0U);
    }
    for (std::size_t i = 0; i < message.points.size(); ++i) {
      message.points[i] = fiber_proximity_ros::to_message(
          fiber_proximity_ros::to_vector(message.points[i]) + velocities[i]);
    }
  }
}

}  // namespace
