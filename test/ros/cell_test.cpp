// The cell's launch file: robot, scene, cables and node find each other, and the cables touch.
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <algorithm>
#include <map>
#include <set>

#include "test/ros/node_test.hpp"

namespace {

using Eigen::Vector3d;

class CellTest : public node_test::NodeTest {
 protected:
  /// Where the tool is at this time, in the world.
  Vector3d tool_at(const ros::Time& stamp) {
    EXPECT_TRUE(node_test::wait_for([&] { return buffer_.canTransform("world", "tool", stamp); }));
    const auto& translation = buffer_.lookupTransform("world", "tool", stamp).transform.translation;
    return fiber_proximity_ros::to_vector(translation);
  }

  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_{buffer_};
  node_test::Recorder<fiber_proximity::ContactArray> environment{node,
                                                                 "/proximity/environment_contacts"};
};

TEST_F(CellTest, TheArmHoldsTheCableWhichIsNeverLongerOrShorter) {
  constexpr std::size_t frames = 60;
  // Those of the first messages are from before tf listened.
  ASSERT_TRUE(
      node_test::wait_for([&] { return buffer_.canTransform("world", "tool", ros::Time()); }));
  fibers.messages.clear();
  ASSERT_TRUE(node_test::wait_for([&] { return fibers.messages.size() >= frames; }));
  std::set<double> places;
  for (const auto& message : fibers.messages) {
    ASSERT_EQ(message->names, (std::vector<std::string>{"held", "cord"}));
    const fiber::FiberAssembly cables = node_test::to_assembly(*message);
    const Vector3d begin = cables.points().front();
    // Where a message has been lost, tf interpolates.
    EXPECT_LT((begin - tool_at(message->header.stamp)).norm(), 1e-3);
    places.insert(begin.y());
    double length = 0.0;
    for (std::uint32_t i = 0; i + 1 < cables.offsets()[1]; ++i) {
      length += (cables.points()[i + 1] - cables.points()[i]).norm();
    }
    EXPECT_NEAR(length, 1.45, 0.01);
  }
  EXPECT_GT(*places.rbegin() - *places.begin(), 0.005);
}

TEST_F(CellTest, DistancesToRobotAndTableAreReportedAndVary) {
  std::map<std::pair<std::string, std::string>, std::set<double>> distances;  // of fibre and object
  std::set<std::uint32_t> at_finger;                                          // segments
  const auto spread = [&](const std::string& fiber, const std::string& object) {
    const std::set<double>& all = distances[{fiber, object}];
    return all.empty() ? 0.0 : *all.rbegin() - *all.begin();
  };
  // Once in its period the arm comes near the cord.
  ASSERT_TRUE(node_test::wait_for([&] {
    for (const auto& message : environment.messages) {
      for (const fiber_proximity::Contact& contact : message->contacts) {
        EXPECT_EQ(contact.type_b, fiber_proximity::Contact::OBJECT);
        const std::string& fiber = message->fiber_names.at(contact.fiber_a);
        const std::string& object = message->object_names.at(contact.fiber_b);
        distances[{fiber, object}].insert(contact.distance);
        if (fiber == "held" && object == "robot/finger_left") {
          at_finger.insert(contact.segment_a);
        }
      }
    }
    environment.messages.clear();
    return spread("cord", "robot/forearm") > 0.01;
  }));
  EXPECT_LT(std::abs(*distances[{"held", "table"}].begin()), 0.005);
  // The gripper may touch what it holds, the first four segments: what is told is the rest of the
  // cable. How far that is depends on whether the arm's transforms come in time.
  EXPECT_EQ(distances.count({"held", "robot/hand"}), 1U);
  ASSERT_FALSE(at_finger.empty());
  EXPECT_GT(*at_finger.begin(), 3U);
}

TEST_F(CellTest, EveryLinkAndObstacleIsThere) {
  const std::set<std::string> expected{"ball",
                                       "bottle",
                                       "box",
                                       "floor",
                                       "rail",
                                       "table",
                                       "robot/base_link",
                                       "robot/finger_left",
                                       "robot/finger_right",
                                       "robot/forearm",
                                       "robot/hand",
                                       "robot/shoulder_link",
                                       "robot/upper_arm",
                                       "robot/wrist_link"};
  EXPECT_NE(environment.wait_for([&](const fiber_proximity::ContactArray& message) {
    return std::set<std::string>(message.object_names.begin(), message.object_names.end()) ==
           expected;
  }),
            nullptr);
}

}  // namespace
