#include "src/ros/inputs/stamp_matcher.hpp"

#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <message_filters/sync_policies/approximate_time.h>
#include <message_filters/synchronizer.h>

#include <algorithm>
#include <random>
#include <utility>

namespace fiber_proximity_ros {
namespace {

using Message = geometry_msgs::PointStamped;
using MessagePtr = boost::shared_ptr<const Message>;
using Sets = std::vector<std::vector<ros::Time>>;

ros::Time milliseconds(std::int64_t time) {
  return ros::Time().fromNSec(static_cast<std::uint64_t>(1'000'000 * (1'000'000 + time)));
}

/// Keeps the stamps of the sets of message_filters, which always calls with nine messages.
struct KeepSet {
  using result_type = void;

  template <class... Pointers>
  void operator()(const Pointers&... messages) const {
    sets->emplace_back();
    (keep(messages), ...);
  }

  void keep(const MessagePtr& message) const { sets->back().push_back(message->header.stamp); }
  void keep(const boost::shared_ptr<const message_filters::NullType>& /*none*/) const {}

  Sets* sets;
};

/// What message_filters itself makes of the same stamps.
template <class... Messages>
class MessageFilters {
 public:
  MessageFilters(double slop, std::size_t queue_size) : synchronizer_(policy(slop, queue_size)) {
    synchronizer_.registerCallback(KeepSet{&sets});
  }

  void add(std::size_t input, const ros::Time& stamp) {
    const auto message = boost::make_shared<Message>();
    message->header.stamp = stamp;
    add(input, ros::MessageEvent<const Message>(message),
        std::make_index_sequence<sizeof...(Messages)>());
  }

  Sets sets;

 private:
  using Policy = message_filters::sync_policies::ApproximateTime<Messages...>;

  static Policy policy(double slop, std::size_t queue_size) {
    Policy policy(static_cast<std::uint32_t>(queue_size));
    policy.setMaxIntervalDuration(ros::Duration(slop));
    return policy;
  }

  template <std::size_t... Indices>
  void add(std::size_t input, const ros::MessageEvent<const Message>& event,
           std::index_sequence<Indices...> /*indices*/) {
    ((Indices == input ? synchronizer_.template add<static_cast<int>(Indices)>(event) : void()),
     ...);
  }

  message_filters::Synchronizer<Policy> synchronizer_;
};

struct Event {
  std::int64_t arrival = 0;  // [ms]
  std::int64_t stamp = 0;    // [ms]
  std::size_t input = 0;
};

/// Trackers that lose frames and take their time for each: all of one camera, or each of its own.
std::vector<Event> random_events(std::mt19937& random, std::size_t inputs) {
  const auto number = [&random](std::int64_t least, std::int64_t most) {
    return std::uniform_int_distribution<std::int64_t>(least, most)(random);
  };
  const bool one_camera = number(0, 1) == 0;
  const std::int64_t jitter = number(0, 3) * 5;
  std::vector<Event> events;
  for (std::size_t input = 0; input < inputs; ++input) {
    const std::int64_t period = one_camera ? 33 : number(20, 60);
    const std::int64_t offset = one_camera ? 0 : number(0, 60);
    const std::int64_t lost = number(0, 3);  // of ten
    std::int64_t last_stamp = -1000;
    std::int64_t last_arrival = 0;
    for (std::int64_t frame = 0; frame < 60; ++frame) {
      const std::int64_t stamp =
          std::max(last_stamp + 1, offset + frame * period + number(0, jitter));
      last_stamp = stamp;
      last_arrival = std::max(last_arrival, stamp + number(0, 80));
      if (number(0, 9) >= lost) {
        events.push_back({last_arrival, stamp, input});
      }
    }
  }
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& a, const Event& b) { return a.arrival < b.arrival; });
  return events;
}

void append(const std::vector<StampSet>& found, Sets& sets) {
  for (const StampSet& set : found) {
    sets.emplace_back();
    for (const std::optional<ros::Time>& stamp : set) {
      sets.back().push_back(stamp.value_or(ros::Time()));
    }
  }
}

/// @returns how many sets there were
template <class... Messages>
std::size_t compare_with_message_filters(std::mt19937& random) {
  const std::vector<Event> events = random_events(random, sizeof...(Messages));
  for (const double slop : {0.0, 0.01, 0.05, 1.0}) {
    for (const std::size_t queue_size : {1, 2, 3, 10}) {
      SCOPED_TRACE("slop " + std::to_string(slop) + ", queue " + std::to_string(queue_size));
      MessageFilters<Messages...> expected(slop, queue_size);
      StampMatcher matcher(sizeof...(Messages), slop, queue_size);
      for (std::size_t i = 0; i < sizeof...(Messages); ++i) {
        // Inputs take part from their first message on, those of message_filters from the start.
        matcher.add(i, milliseconds(-100'000 + 10'000 * static_cast<std::int64_t>(i)));
        expected.add(i, milliseconds(-100'000 + 10'000 * static_cast<std::int64_t>(i)));
      }
      matcher.take();
      expected.sets.clear();
      Sets sets;
      for (const Event& event : events) {
        matcher.add(event.input, milliseconds(event.stamp));
        expected.add(event.input, milliseconds(event.stamp));
        append(matcher.take(), sets);
        EXPECT_EQ(sets.size(), expected.sets.size());
      }
      EXPECT_EQ(sets, expected.sets);
      if (::testing::Test::HasFailure()) {
        return 0;
      }
      if (slop == 0.05 && queue_size == 10) {
        return sets.size();
      }
    }
  }
  return 0;
}

TEST(StampMatcher, SetsAreThoseOfMessageFilters) {
  ros::Time::init();
  std::mt19937 random(16);
  std::size_t sets = 0;
  for (int round = 0; round < 60 && !HasFailure(); ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    sets += compare_with_message_filters<Message, Message>(random);
    sets += compare_with_message_filters<Message, Message, Message>(random);
    sets += compare_with_message_filters<Message, Message, Message, Message>(random);
  }
  EXPECT_GT(sets, 1000U) << "hardly anything was compared";
}

StampSet set_of(const std::vector<std::int64_t>& stamps) {
  StampSet set;
  for (const std::int64_t stamp : stamps) {
    set.emplace_back(stamp < 0 ? std::nullopt : std::optional<ros::Time>(milliseconds(stamp)));
  }
  return set;
}

TEST(StampMatcher, EqualStampsAreASetAtOnce) {
  StampMatcher matcher(12, 0.05, 10);  // more than message_filters takes
  for (std::int64_t stamp = 0; stamp < 330; stamp += 33) {
    for (std::size_t input = 0; input < 12; ++input) {
      if (stamp > 0) {
        EXPECT_TRUE(matcher.take().empty());
      }
      matcher.add(input, milliseconds(stamp));
    }
    const std::vector<StampSet> found = matcher.take();
    if (stamp > 0) {  // at first each is heard alone
      EXPECT_EQ(found, std::vector<StampSet>{set_of(std::vector<std::int64_t>(12, stamp))});
    }
  }
}

TEST(StampMatcher, AnInputThatIsLeftOutStopsNobodyUntilItIsBack) {
  StampMatcher matcher(3, 0.05, 10);
  for (std::size_t input = 0; input < 3; ++input) {
    matcher.add(input, milliseconds(0));
    EXPECT_EQ(matcher.take().size(), input == 0 ? 1U : 0U);
  }
  matcher.add(0, milliseconds(100));
  matcher.add(1, milliseconds(100));
  matcher.add(0, milliseconds(200));
  matcher.add(1, milliseconds(200));
  EXPECT_TRUE(matcher.take().empty()) << "without the third";
  matcher.leave_out(2);
  EXPECT_EQ(matcher.take(),
            (std::vector<StampSet>{set_of({100, 100, -1}), set_of({200, 200, -1})}));
  matcher.add(0, milliseconds(300));
  matcher.add(1, milliseconds(300));
  EXPECT_EQ(matcher.take(), (std::vector<StampSet>{set_of({300, 300, -1})}));
  matcher.add(2, milliseconds(400));
  matcher.add(1, milliseconds(400));
  EXPECT_TRUE(matcher.take().empty()) << "it takes part again";
  matcher.add(0, milliseconds(400));
  EXPECT_EQ(matcher.take(), (std::vector<StampSet>{set_of({400, 400, 400})}));
}

TEST(StampMatcher, AnUnmatchedInputIsLeftOutUntilOneOfItsStampsIsNearTheOthers) {
  StampMatcher matcher(3, 0.01, 10);
  const auto send = [&matcher](std::int64_t stamp, std::int64_t stamp_of_third) {
    matcher.add(2, milliseconds(stamp_of_third));  // ahead of the others each time
    matcher.add(0, milliseconds(stamp));
    matcher.add(1, milliseconds(stamp));
    return matcher.take();
  };
  send(0, -10'000);
  for (std::int64_t stamp = 33; stamp < 500; stamp += 33) {
    EXPECT_TRUE(send(stamp, stamp - 10'000).empty());
  }
  EXPECT_TRUE(matcher.is_waiting());
  matcher.leave_out_farthest(milliseconds(500));
  EXPECT_FALSE(matcher.is_unmatched(0));
  EXPECT_FALSE(matcher.is_unmatched(1));
  EXPECT_TRUE(matcher.is_unmatched(2));
  EXPECT_GE(matcher.take().size(), 9U) << "what was kept";
  for (std::int64_t stamp = 528; stamp < 1000; stamp += 33) {
    EXPECT_EQ(send(stamp, stamp - 9'000), (std::vector<StampSet>{set_of({stamp, stamp, -1})}));
  }
  EXPECT_EQ(send(1000, 1000), (std::vector<StampSet>{set_of({1000, 1000, 1000})}));
  EXPECT_FALSE(matcher.is_unmatched(2));
  EXPECT_EQ(send(1033, 1033), (std::vector<StampSet>{set_of({1033, 1033, 1033})}));
}

TEST(StampMatcher, StampsFarApartAreNoSetEvenACenturyApart) {
  StampMatcher matcher(2, 1e9, 10);
  matcher.add(0, ros::Time(1, 0));
  matcher.take();
  matcher.add(1, ros::Time(4'294'967'295U, 0));
  matcher.add(0, ros::Time(2, 0));
  EXPECT_TRUE(matcher.take().empty());
  StampMatcher endless(2, 1e300, 10);
  endless.add(0, ros::Time(1, 0));
  endless.take();
  endless.add(1, ros::Time(4'294'967'295U, 0));
  endless.add(0, ros::Time(2, 0));
  endless.add(0, ros::Time(4'294'967'295U, 0));
  EXPECT_EQ(endless.take().size(), 1U);
}

TEST(StampMatcher, ResetForgetsAll) {
  StampMatcher matcher(2, 0.05, 10);
  matcher.add(0, milliseconds(1000));
  matcher.add(1, milliseconds(1000));
  matcher.reset();
  EXPECT_TRUE(matcher.take().empty());
  matcher.add(1, milliseconds(10));  // alone, and before all others
  EXPECT_EQ(matcher.take(), (std::vector<StampSet>{set_of({-1, 10})}));
}

}  // namespace
}  // namespace fiber_proximity_ros
