// Stamps nobody should send, and messages that get lost on their way.
#include <algorithm>
#include <sstream>

#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

namespace {

using fiber_proximity::FiberArray;
using fiber_proximity::InputStatistics;
using test_messages::header;
using test_messages::Points;

class StampsTest : public node_test::NodeTest {
 protected:
  void SetUp() override {
    a_ = advertise<FiberArray>("a");
    b_ = advertise<FiberArray>("b");
    connect(a_, message(ros::Time()));
  }

  static FiberArray message(const ros::Time& stamp) {
    return test_messages::fiber_array(header("world", stamp), {{0, 0, 0}, {1, 0, 0}});
  }

  /// What the node says about an input after it has handled what came before, and a's stamp then.
  InputStatistics statistics_of(const std::string& input) {
    const ros::Time stamp = new_stamp();
    a_.publish(message(stamp));
    const fiber_proximity::Statistics* now = statistics.wait_for(stamp);
    return now == nullptr ? InputStatistics() : *input_of(*now, input);
  }

  InputStatistics wait_for_received(const std::string& input, std::uint64_t received) {
    InputStatistics now;
    EXPECT_TRUE(
        node_test::wait_for([&] { return (now = statistics_of(input)).received >= received; }));
    return now;
  }

  /// Sends messages of b until one is accepted.
  /// @param ahead [s] of the time
  /// @returns its stamp
  ros::Time have_accepted(double ahead = 0.0) {
    ros::Time stamp;
    ros::SteadyTime last;
    EXPECT_TRUE(node_test::wait_for([&] {
      if (fibers.find([stamp](const FiberArray& m) { return m.header.stamp == stamp; })) {
        return true;
      }
      if ((ros::SteadyTime::now() - last).toSec() > 0.3) {
        last = ros::SteadyTime::now();
        stamp = new_stamp() + ros::Duration(ahead);
        b_.publish(message(stamp));
      }
      return false;
    }));
    return stamp;
  }

  /// Sends a message of b that is refused.
  /// @returns why
  std::string have_refused(const FiberArray& sent) {
    const std::uint64_t before = statistics_of("b").refused;
    b_.publish(sent);
    InputStatistics now;
    EXPECT_TRUE(node_test::wait_for([&] { return (now = statistics_of("b")).refused > before; }));
    EXPECT_EQ(now.refused, before + 1);
    return now.last_error;
  }

  static std::string text(const ros::Time& stamp) {
    std::ostringstream text;
    text << stamp;
    return text.str();
  }

  ros::Publisher a_;
  ros::Publisher b_;
};

TEST_F(StampsTest, AStampOfTheFutureIsRefusedAndNoAnswerHasIt) {
  for (const ros::Time& stamp :
       {ros::Time::now() + ros::Duration(3600.0), ros::Time::now() + ros::Duration(60.0),
        ros::Time(4'294'967'295U, 0)}) {
    const std::string error = have_refused(message(stamp));
    EXPECT_EQ(error.rfind("its stamp " + text(stamp) + " is ", 0), 0U) << error;
    EXPECT_NE(error.find(" s ahead of the node's time "), std::string::npos) << error;
    EXPECT_NE(error.find(", it may be 0.75 s ahead (max_stamp_ahead)"), std::string::npos) << error;
  }
  FiberArray malformed = message(ros::Time(1, 0));
  malformed.header.stamp.nsec = 4'000'000'000U;
  EXPECT_EQ(have_refused(malformed),
            "its stamp has 4000000000 nanoseconds, it must have fewer than 1000000000");
  expect_log("input 'b'");
  for (const auto& answer : contacts.messages) {
    EXPECT_LE(answer->header.stamp, new_stamp());
  }
  const ros::Time accepted = have_accepted(0.2);  // as the clocks of two machines may differ
  ros::Time::sleepUntil(accepted);                // answers have this stamp until then
}

TEST_F(StampsTest, AnOlderStampIsRefusedByNameUntilTheInputHasTimedOut) {
  const ros::Time newest = have_accepted();
  const ros::Time older = newest - ros::Duration(100.0);
  EXPECT_EQ(have_refused(message(older)), "its stamp " + text(older) + " is older than " +
                                              text(newest) + ", that of the message before it");
  const std::uint64_t refused = statistics_of("b").refused;

  // A recording without simulated time starts again: its beginning is lost, no more.
  const ros::Time begin = ros::Time(1.0);  // the past is unlimited
  ros::Time next = begin;
  double oldest = 0.0;
  ASSERT_TRUE(node_test::wait_for([&] {
    b_.publish(message(next += ros::Duration(0.01)));
    const InputStatistics b = statistics_of("b");
    oldest = std::max(oldest, b.age);
    return b.age < oldest && b.fibers == 1;
  })) << "it never starts anew";
  EXPECT_GT(oldest, 0.5);
  EXPECT_GT(statistics_of("b").refused, refused) << "an older stamp was taken at once";
  const std::uint64_t refused_then = statistics_of("b").refused;
  b_.publish(message(next + ros::Duration(0.01)));
  EXPECT_EQ(statistics_of("b").refused, refused_then);
}

TEST_F(StampsTest, MarkersAreNotNumberedAndTheirLossIsUnknown) {
  const ros::Publisher c = advertise<visualization_msgs::MarkerArray>("c");
  for (int i = 0; i < 3; ++i) {
    const Points points{{0, 0, 0}, {1, 0, 0}};
    c.publish(test_messages::spheres_and_cylinders(header("world", new_stamp()), points));
  }
  EXPECT_EQ(wait_for_received("c", 1).dropped, -1);
}

}  // namespace
