// An input whose fibres cost too much is left out, named, and comes back; the others go on.
#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"
#include "test/support/random.hpp"

namespace {

using Eigen::Vector3d;
using fiber_proximity::ContactArray;
using fiber_proximity::FiberArray;

class InputBudgetNodeTest : public node_test::NodeTest {
 protected:
  /// In no order, as a camera sees them: nearly all segments are near all others.
  static std::vector<Vector3d> camera_points(int count) {
    fiber::test::Random random;
    std::vector<Vector3d> points;
    for (int i = 0; i < count; ++i) {
      points.push_back(0.1 * random.in_cube());
    }
    return points;
  }

  void send_rope() {
    FiberArray message = test_messages::fiber_array(test_messages::header("world", new_stamp()),
                                                    {{5, 0, 0}, {6, 0, 0}, {7, 0, 0}});
    message.names = {"rope"};
    message.radii = {0.01};
    rope_.publish(message);
  }

  void send_cloud(const std::vector<Vector3d>& points) {
    cloud_.publish(
        test_messages::point_cloud2(test_messages::header("world", new_stamp()), points));
  }

  /// Sends both until there is an answer about these fibres.
  const ContactArray* answer_about(const std::vector<std::string>& names,
                                   const std::vector<Vector3d>& points) {
    const std::size_t before = contacts.messages.size();
    const ContactArray* found = nullptr;
    node_test::wait_for([&] {
      send_cloud(points);
      send_rope();
      ros::WallDuration(0.02).sleep();
      for (std::size_t i = before; i < contacts.messages.size(); ++i) {
        if (contacts.messages[i]->fiber_names == names) {
          found = contacts.messages[i].get();
        }
      }
      return found != nullptr;
    });
    return found;
  }

  ros::Publisher rope_ = advertise<FiberArray>("/rope");
  ros::Publisher cloud_ = advertise<sensor_msgs::PointCloud2>("/cloud");
};

TEST_F(InputBudgetNodeTest, WhatCostsTooMuchIsLeftOutAndTheOthersGoOn) {
  const std::vector<Vector3d> few{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  const ContactArray* answer = answer_about({"rope", "/cloud"}, few);
  ASSERT_NE(answer, nullptr);
  EXPECT_TRUE(answer->complete);

  // Its own pairs are more than may be, but for the node's limits they would be examined.
  answer = answer_about({"rope"}, camera_points(1000));
  ASSERT_NE(answer, nullptr);
  EXPECT_FALSE(answer->complete);
  ASSERT_EQ(answer->unknown.size(), 1U);
  EXPECT_EQ(answer->unknown[0].rfind("input /cloud since ", 0), 0U) << answer->unknown[0];
  EXPECT_NE(answer->unknown[0].find("its 999 segments cost too much: by themselves they have more "
                                    "than 20000 pairs within the margin of 0 m or next to it "
                                    "(max_pairs)"),
            std::string::npos)
      << answer->unknown[0];
  expect_log("input '/cloud' (sensor_msgs/PointCloud2): message refused: its 999 segments");
  for (int i = 0; i < 20; ++i) {
    answer = answer_about({"rope"}, camera_points(1000));
    ASSERT_NE(answer, nullptr);
    EXPECT_FALSE(answer->complete);
  }
  for (const auto& told : contacts.messages) {
    EXPECT_LE(told->contacts.size(), 10U) << "they were among the fibres for once";
  }

  answer = answer_about({"rope", "/cloud"}, few);
  ASSERT_NE(answer, nullptr) << "it does not come back";
  EXPECT_TRUE(answer->complete);
}

}  // namespace
