// Who listens in the same process, as nodelets of a manager do, gets messages themselves.
#include "src/ros/outputs/output_topic.hpp"

#include <set>

#include "test/ros/node_test.hpp"

namespace {

using fiber_proximity::FiberArray;

class OutputTopicTest : public ::testing::Test {
 protected:
  OutputTopicTest()
      : listener_(node_.subscribe<FiberArray>(
            "in_process", 100,
            [this](const FiberArray::ConstPtr& message) { received_.push_back(message); })) {}

  /// Publishes one with this radius. @returns where it was
  const FiberArray* publish(double radius) {
    const std::size_t before = received_.size();
    FiberArray& message = topic_.message();
    message.radii = {radius};
    topic_.publish();
    EXPECT_TRUE(node_test::wait_for([&] { return received_.size() > before; }));
    return &message;
  }

  ros::NodeHandle node_;
  fiber_proximity_ros::OutputTopic<FiberArray> topic_{node_, "in_process", [] {}};
  std::vector<FiberArray::ConstPtr> received_;
  ros::Subscriber listener_;
};

TEST_F(OutputTopicTest, HandsOverTheMessageItself) {
  const FiberArray* const sent = publish(0.5);
  ASSERT_EQ(received_.size(), 1U);
  EXPECT_EQ(received_[0].get(), sent) << "this is a copy";
  EXPECT_EQ(received_[0]->radii, std::vector<double>{0.5});
}

TEST_F(OutputTopicTest, LeavesMessagesToThoseWhoHoldThem) {
  constexpr int count = 40;
  for (int i = 0; i < count; ++i) {
    publish(i);
  }
  ASSERT_EQ(received_.size(), std::size_t{count});
  for (int i = 0; i < count; ++i) {
    EXPECT_EQ(received_[static_cast<std::size_t>(i)]->radii, std::vector<double>{double(i)});
  }
}

TEST_F(OutputTopicTest, UsesTheMemoryAgainOfMessagesThatNobodyHolds) {
  std::set<const FiberArray*> places;
  for (int i = 0; i < 100; ++i) {
    places.insert(publish(i));
    received_.clear();
  }
  EXPECT_LE(places.size(), 2U);
}

TEST_F(OutputTopicTest, PublishesEvenWhatNobodyHasWritten) {
  topic_.publish();
  EXPECT_TRUE(node_test::wait_for([&] { return received_.size() == 1; }));
}

}  // namespace
