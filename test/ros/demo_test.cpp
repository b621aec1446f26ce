// The demo's launch file: player and node find each other, and the cables touch.
#include "test/ros/node_test.hpp"

namespace {

class DemoTest : public node_test::NodeTest {};

TEST_F(DemoTest, CablesTouchAndContactsAreThoseOfBruteForce) {
  const fiber_proximity::ContactArray* answer = nullptr;
  const fiber_proximity::FiberArray* merged = nullptr;
  ASSERT_TRUE(node_test::wait_for([&] {
    answer = contacts.find([&](const fiber_proximity::ContactArray& message) {
      merged = fibers.find([&](const fiber_proximity::FiberArray& candidate) {
        return candidate.header.stamp == message.header.stamp;
      });
      return merged != nullptr && message.contacts.size() > 3;
    });
    return answer != nullptr;
  }));
  EXPECT_EQ(merged->offsets.size(), 6U);
  EXPECT_EQ(answer->header.frame_id, "world");
  fiber::QueryOptions options;
  double neighbour_skip_length = 0.0;
  ASSERT_TRUE(node.getParam("/proximity/neighbour_skip_length", neighbour_skip_length));
  options.neighbour_skip_length = neighbour_skip_length;
  node_test::expect_brute_force(*answer, *merged, options);
}

}  // namespace
