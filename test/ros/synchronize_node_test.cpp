// Inputs that are synchronised by their stamps, through the running node.
#include <array>
#include <cmath>

#include "test/ros/messages.hpp"
#include "test/ros/simulated_time_test.hpp"

namespace {

using fiber_proximity::FiberArray;
using test_messages::header;

using Names = std::vector<std::string>;

class SynchronizeTest : public node_test::SimulatedTimeTest {
 protected:
  void SetUp() override {
    for (std::size_t i = 0; i < 3; ++i) {
      inputs_[i] = advertise<FiberArray>(std::string(1, "abc"[i]));
    }
    ASSERT_TRUE(send_until_answered({0, 1, 2}, Names{"a", "b", "c"}));
    first_ = fibers.messages.size();
  }

  /// A fibre whose points tell the number of its frame.
  static FiberArray message(const ros::Time& stamp, double frame) {
    return test_messages::fiber_array(header("world", stamp), {{0, frame, 0}, {1, frame, 0}});
  }

  /// Sends the next frame on these inputs, one after another.
  void send(const std::vector<std::size_t>& inputs, double seconds_apart = 0.0) {
    ++frame_;
    pass(0.05);
    stamp_ = now();
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const double late = seconds_apart * static_cast<double>(i);
      inputs_[inputs[i]].publish(message(stamp_ + ros::Duration(late), frame_));
      ros::WallDuration(0.01).sleep();  // so that they arrive apart
    }
  }

  /// Sends frames as a camera would until there is a new answer about these fibres, and waits for
  /// that to the last frame.
  bool send_until_answered(
      const std::vector<std::size_t>& inputs, const Names& names,
      const std::function<void()>& also = [] {}) {
    const std::size_t before = fibers.messages.size();
    const bool answered = node_test::wait_for([&] {
      send(inputs);
      also();
      return std::any_of(fibers.messages.begin() + static_cast<std::ptrdiff_t>(before),
                         fibers.messages.end(),
                         [&](const auto& answer) { return answer->names == names; });
    });
    return answered && fibers.wait_for(stamp_) != nullptr;
  }

  /// No answer is a mixture of frames.
  void expect_no_mixture() const {
    for (std::size_t i = first_; i < fibers.messages.size(); ++i) {
      for (const geometry_msgs::Point& point : fibers.messages[i]->points) {
        EXPECT_EQ(point.y, fibers.messages[i]->points.front().y) << "answer " << i;
      }
    }
  }

  std::array<ros::Publisher, 3> inputs_;
  double frame_ = 0.0;
  ros::Time stamp_;
  std::size_t first_ = 0;  // answer of the test itself
};

TEST_F(SynchronizeTest, ThreeInputsOfEqualStampsGiveOneAnswer) {
  for (int frame = 0; frame < 30; ++frame) {
    const std::size_t before = fibers.messages.size();
    send(frame % 2 == 0 ? std::vector<std::size_t>{0, 1, 2} : std::vector<std::size_t>{2, 0, 1});
    const FiberArray* answer = fibers.wait_for(stamp_);
    ASSERT_NE(answer, nullptr) << "frame " << frame;
    EXPECT_EQ(answer->names, (Names{"a", "b", "c"}));
    EXPECT_EQ(answer->points.front().y, frame_);
    EXPECT_EQ(fibers.messages.size(), before + 1);
  }
  expect_no_mixture();
}

TEST_F(SynchronizeTest, StampsWithinTheSlopBelongTogether) {
  for (int frame = 0; frame < 20; ++frame) {
    send({0, 1, 2}, 0.008);
  }
  ASSERT_NE(fibers.wait_for([this](const FiberArray& m) { return m.points[0].y == frame_ - 1.0; }),
            nullptr);
  EXPECT_GE(fibers.messages.size() - first_, 5U);
  expect_no_mixture();
}

TEST_F(SynchronizeTest, AnInputThatDiesIsLeftOutAndStopsNobodyUntilItIsBack) {
  ASSERT_TRUE(send_until_answered({0, 1}, Names{"a", "b"}));
  ASSERT_TRUE(node_test::wait_for([&] { return !logs_of("input 'c'").empty(); }));
  EXPECT_NE(logs_of("input 'c'").back().find("no new message for 2 s"), std::string::npos);
  for (int frame = 0; frame < 5; ++frame) {
    send({1, 0});
    const FiberArray* answer = fibers.wait_for(stamp_);
    ASSERT_NE(answer, nullptr) << "frame " << frame;
    EXPECT_EQ(answer->names, (Names{"a", "b"}));
  }
  EXPECT_TRUE(send_until_answered({0, 1, 2}, Names{"a", "b", "c"}));
  expect_no_mixture();
}

/// While one is waited for that has died, the others match nobody: they are not to blame.
TEST_F(SynchronizeTest, AnInputThatDiesTakesNobodyWithIt) {
  ASSERT_TRUE(send_until_answered({0, 1, 2}, Names{"a", "b", "c"}));
  pass(1.0);  // c falls silent a second before the others
  send({0, 1});
  const double last_of_both = frame_;
  send({0});  // waits for b's when c is given up
  pass(1.5);
  const FiberArray* answer = fibers.wait_for(
      [&](const FiberArray& m) { return !m.points.empty() && m.points.front().y == last_of_both; });
  ASSERT_NE(answer, nullptr);
  EXPECT_EQ(answer->names, (Names{"a", "b"}));
  EXPECT_TRUE(logs_of("no stamp within").empty());
}

TEST_F(SynchronizeTest, AnInputWithAnotherClockIsLeftOutByNameUntilItsStampsMatch) {
  const auto send_c = [this] { inputs_[2].publish(message(stamp_ - ros::Duration(5.0), -1.0)); };
  // Its own last stamp is newer: first it must time out.
  ASSERT_TRUE(send_until_answered({0, 1}, Names{"a", "b"}));
  ASSERT_TRUE(node_test::wait_for([&] {
    send({0, 1});
    send_c();
    return !logs_of("no stamp within 0.02 s (synchronize_slop)").empty();
  }));
  EXPECT_EQ(logs_of("no stamp within").back().rfind("input 'c' ", 0), 0U)
      << logs_of("no stamp within").back();
  for (int frame = 0; frame < 5; ++frame) {
    send({0, 1});
    send_c();
    const FiberArray* answer = fibers.wait_for(stamp_);
    ASSERT_NE(answer, nullptr) << "frame " << frame;
    EXPECT_EQ(answer->names, (Names{"a", "b"}));
  }
  EXPECT_TRUE(send_until_answered({0, 1, 2}, Names{"a", "b", "c"}));
  expect_no_mixture();
}

}  // namespace
