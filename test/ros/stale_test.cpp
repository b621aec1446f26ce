// Trackers that stop, freeze and come back.
#include <diagnostic_msgs/DiagnosticArray.h>

#include <optional>

#include "fiber_proximity/ContactEvent.h"
#include "test/ros/messages.hpp"
#include "test/ros/simulated_time_test.hpp"

namespace {

using fiber_proximity::ContactArray;
using fiber_proximity::FiberArray;
using test_messages::header;

using Names = std::vector<std::string>;

class StaleTest : public node_test::SimulatedTimeTest {
 protected:
  void SetUp() override { ASSERT_TRUE(wait_for_answer(Names{"a", "b"}, &a_, &b_)); }

  static FiberArray message(const ros::Time& stamp) {
    return test_messages::fiber_array(header("world", stamp), {{0, 0, 0}, {1, 0, 0}});
  }

  /// Publishes as time goes on: on one topic with new stamps, on another with this one (default:
  /// new ones, too), until there is an answer about these fibres that is newer than the call.
  bool wait_for_answer(const Names& names, const ros::Publisher* moving = nullptr,
                       const ros::Publisher* other = nullptr,
                       std::optional<ros::Time> stamp_of_other = {}) {
    const std::size_t before = contacts.messages.size();
    return node_test::wait_for([&] {
      if (moving != nullptr) {
        moving->publish(message(now()));
      }
      if (other != nullptr) {
        other->publish(message(stamp_of_other.value_or(now())));
      }
      pass(0.05);
      ros::WallDuration(0.02).sleep();  // or a node that a busy machine holds up finds itself late
      return std::any_of(contacts.messages.begin() + static_cast<std::ptrdiff_t>(before),
                         contacts.messages.end(),
                         [&](const auto& answer) { return answer->fiber_names == names; });
    });
  }

  ros::Publisher a_ = advertise<FiberArray>("a");
  ros::Publisher b_ = advertise<FiberArray>("b");
};

TEST_F(StaleTest, ATrackerThatStopsIsLeftOutUntilItIsBack) {
  const node_test::Recorder<diagnostic_msgs::DiagnosticArray> diagnostics(node, "/diagnostics");
  const node_test::Recorder<fiber_proximity::ContactEvent> events(node,
                                                                  "/proximity/contact_events");
  ASSERT_TRUE(events.wait_for_connection());
  ASSERT_TRUE(wait_for_answer(Names{"a", "b"}, &a_, &b_));
  const std::size_t logged = logs_of("input 'b'").size();
  ASSERT_TRUE(wait_for_answer(Names{"a"}, &a_));
  // They lie on each other, and as far as anybody knows they still do.
  const auto* lost = events.wait_for([](const fiber_proximity::ContactEvent& event) {
    return event.kind != fiber_proximity::ContactEvent::BEGAN;
  });
  ASSERT_NE(lost, nullptr);
  EXPECT_EQ(lost->kind, fiber_proximity::ContactEvent::LOST);
  EXPECT_EQ(lost->body_a, "a");
  EXPECT_EQ(lost->body_b, "b");
  const auto* stale = statistics.wait_for([this](const fiber_proximity::Statistics& message) {
    const auto* b = input_of(message, "b");
    return b->stale && message.header.stamp == contacts.messages.back()->header.stamp;
  });
  ASSERT_NE(stale, nullptr);
  EXPECT_EQ(stale->fibers, 1U);
  EXPECT_EQ(input_of(*stale, "b")->fibers, 0U);
  EXPECT_GE(input_of(*stale, "b")->age, 1.0);
  EXPECT_FALSE(input_of(*stale, "a")->stale);
  const auto is_stale = [](const diagnostic_msgs::DiagnosticArray& array) {
    return std::any_of(array.status.begin(), array.status.end(), [](const auto& status) {
      return status.name == "proximity: input b" && status.level == status.ERROR &&
             status.message.rfind("stale: ", 0) == 0;
    });
  };
  // They come once a second.
  EXPECT_TRUE(node_test::wait_for([&] {
    a_.publish(message(now()));
    pass(0.1);
    return std::any_of(diagnostics.messages.begin(), diagnostics.messages.end(),
                       [&](const auto& array) { return is_stale(*array); });
  }));
  // The log takes a way of its own and may come after the answer.
  ASSERT_TRUE(node_test::wait_for([&] { return logs_of("input 'b'").size() > logged; }));
  ASSERT_EQ(logs_of("input 'b'").size(), logged + 1) << "said once";
  EXPECT_EQ(logs_of("input 'b'").back(),
            "input 'b' (fiber_proximity/FiberArray): no new message for 1 s; its 1 fibre(s) are "
            "left out");

  EXPECT_TRUE(wait_for_answer(Names{"a", "b"}, &a_, &b_));
}

TEST_F(StaleTest, AFibreThatItsTrackerDoesNotSendAnyMoreHasEndedItsTouches) {
  const node_test::Recorder<fiber_proximity::ContactEvent> events(node,
                                                                  "/proximity/contact_events");
  ASSERT_TRUE(events.wait_for_connection());
  ASSERT_TRUE(wait_for_answer(Names{"a", "b"}, &a_, &b_));
  FiberArray none;
  none.header = header("world", now());
  none.offsets = {0};
  b_.publish(none);
  const auto* ended = events.wait_for([](const fiber_proximity::ContactEvent& event) {
    return event.kind != fiber_proximity::ContactEvent::BEGAN;
  });
  ASSERT_NE(ended, nullptr);
  EXPECT_EQ(ended->kind, fiber_proximity::ContactEvent::ENDED) << "that it is gone is known";
  EXPECT_TRUE(contacts.messages.back()->complete);
}

TEST_F(StaleTest, ATrackerThatRepeatsItsStampIsFrozen) {
  const ros::Time frozen = now();
  const std::size_t logged = logs_of("input 'b'").size();
  ASSERT_TRUE(wait_for_answer(Names{"a"}, &a_, &b_, frozen));
  ASSERT_TRUE(node_test::wait_for([&] { return logs_of("input 'b'").size() > logged; }));
  ASSERT_EQ(logs_of("input 'b'").size(), logged + 1);
  EXPECT_NE(logs_of("input 'b'").back().find("its messages repeat their stamp"), std::string::npos);
}

TEST_F(StaleTest, WhenAllStopTheLastAnswersAreEmptyAndIncomplete) {
  const ros::Time frozen = now();
  ASSERT_TRUE(wait_for_answer(Names{}, nullptr, &b_, frozen));
  const std::size_t answers = contacts.messages.size();
  const ContactArray last = *contacts.messages.back();
  EXPECT_TRUE(last.contacts.empty());
  EXPECT_FALSE(last.has_minimum);
  EXPECT_FALSE(last.complete);
  EXPECT_EQ(last.minimum_lower, -std::numeric_limits<double>::infinity());
  ASSERT_EQ(last.unknown.size(), 2U);
  EXPECT_EQ(last.unknown[0].rfind("input a since ", 0), 0U) << last.unknown[0];
  EXPECT_NE(last.unknown[0].find(": no new message for 1 s"), std::string::npos);
  EXPECT_EQ(last.header.frame_id, "world");
  for (int i = 0; i < 20; ++i) {
    b_.publish(message(frozen));
    EXPECT_FALSE(ask().success);
  }
  const ros::Time stamp = now();
  a_.publish(message(stamp));
  // An answer without fibres has the time of the answer, which may be this one.
  ASSERT_NE(contacts.wait_for([&](const ContactArray& answer) {
    return answer.header.stamp == stamp && answer.fiber_names == Names{"a"};
  }),
            nullptr);
  for (std::size_t i = answers; i < contacts.messages.size(); ++i) {
    const ContactArray& answer = *contacts.messages[i];
    EXPECT_TRUE(answer.fiber_names.empty() || answer.header.stamp == stamp)
        << "an old answer was published as new";
    EXPECT_FALSE(answer.complete) << "b is still unknown";
  }
  EXPECT_TRUE(ask().success);
}

TEST_F(StaleTest, MessagesWithoutStampAreNewEachTime) {
  const std::size_t logged = logs_of("input 'b'").size();
  const ros::Time begin = now();
  while ((now() - begin).toSec() < 2.5) {
    ASSERT_TRUE(wait_for_answer(Names{"a", "b"}, &a_, &b_, ros::Time()));
  }
  EXPECT_EQ(logs_of("input 'b'").size(), logged);
}

}  // namespace
