// The running node with ~continuous on random ropes: ids, events and ages beside a tracker of its
// own that looks at all pairs of an answer.
#include <array>
#include <map>
#include <set>

#include "test/ros/continuous_fixture.hpp"
#include "test/support/random.hpp"

namespace {

using namespace continuous_test;  // NOLINT(google-build-using-namespace)

/// Two straight cables that touch all along, bulging apart in the middle.
FiberArray parted_in_the_middle(const std::set<std::uint32_t>& touching, double radius_of_both) {
  test_messages::Points points;
  for (std::uint32_t i = 0; i < 20; ++i) {
    const std::uint32_t place = i % 10;
    const double height = touching.count(place) > 0 ? 0.012 : 0.1;
    points.emplace_back(0.1 * place, 0.0, i < 10 ? 0.0 : height);
  }
  FiberArray message = test_messages::fiber_array(test_messages::header("world"), points);
  message.offsets = {0, 10, 20};
  message.names = {"low", "high"};
  message.radii = {radius_of_both};
  return message;
}

TEST_F(ContinuousTest, WhatPartsDuringAStepIsTwoTouchesInThatAnswer) {
  const double radius_of_both = 0.007;  // they touch where they are 0.012 apart
  ASSERT_NE(answer_to(parted_in_the_middle({4, 5}, radius_of_both)), nullptr);
  const std::size_t events_before = events_.messages.size();
  const ContactArray* const answer = answer_to(parted_in_the_middle({1, 2, 7, 8}, radius_of_both));
  ASSERT_NE(answer, nullptr);
  ASSERT_TRUE(answer->continuous);
  std::map<bool, std::set<std::uint64_t>> ids;  // on the left and on the right
  for (const Contact& contact : answer->contacts) {
    if (!contact.gone) {
      ids[contact.segment_a > 4].insert(contact.id);
    }
  }
  ASSERT_EQ(ids[false].size(), 1U);
  ASSERT_EQ(ids[true].size(), 1U);
  EXPECT_NE(*ids[false].begin(), *ids[true].begin());
  ASSERT_TRUE(node_test::wait_for([&] {
    return std::count_if(events_.messages.begin() + static_cast<std::ptrdiff_t>(events_before),
                         events_.messages.end(), [&](const auto& event) {
                           return event->header.stamp == answer->header.stamp;
                         }) >= 1;
  })) << "one goes on, the other begins";
  for (std::size_t i = events_before; i < events_.messages.size(); ++i) {
    const ContactEvent& event = *events_.messages[i];
    if (event.header.stamp == answer->header.stamp && event.kind == ContactEvent::BEGAN) {
      // They come from 0.1 to 0.012 m, and touch from 0.014 m on.
      const double expected = 0.1 * (0.1 - 0.014) / (0.1 - 0.012);
      EXPECT_LE(after(event.time_lower, *answer), expected + 1e-6);
      EXPECT_GE(after(event.time_upper, *answer), expected - 1e-6);
      EXPECT_LT((event.time_upper - event.time_lower).toSec(), 1e-3);
    }
  }
}

using PairKey = std::array<std::uint32_t, 4>;

PairKey key_of(const Contact& contact) {
  return {contact.fiber_a, contact.segment_a, contact.fiber_b, contact.segment_b};
}

bool are_neighbours(const PairKey& x, const PairKey& y) {
  const auto apart = [](std::uint32_t a, std::uint32_t b) { return a < b ? b - a : a - b; };
  return x[0] == y[0] && x[2] == y[2] && apart(x[1], y[1]) <= 1 && apart(x[3], y[3]) <= 1;
}

/// The numbers of the patches that pairs hang together in.
std::map<PairKey, int> patches_of(const std::set<PairKey>& pairs) {
  std::map<PairKey, int> patches;
  int count = 0;
  for (const PairKey& first : pairs) {
    if (patches.count(first) > 0) {
      continue;
    }
    std::vector<PairKey> open{first};
    patches[first] = count;
    while (!open.empty()) {
      const PairKey pair = open.back();
      open.pop_back();
      for (const PairKey& other : pairs) {
        if (patches.count(other) == 0 && are_neighbours(pair, other)) {
          patches[other] = count;
          open.push_back(other);
        }
      }
    }
    ++count;
  }
  return patches;
}

TEST_F(ContinuousTest, TouchesOfRandomRopesAreThoseThatHangTogether) {
  fiber::test::Random random;
  constexpr std::uint32_t ropes = 3;
  constexpr std::uint32_t points_each = 12;
  std::vector<Vector3d> points;
  FiberArray message;
  message.header = test_messages::header("world");
  message.radii = {0.02};
  message.offsets = {0};
  for (std::uint32_t rope = 0; rope < ropes; ++rope) {
    message.names.push_back("rope " + std::to_string(rope));
    for (std::uint32_t i = 0; i < points_each; ++i) {
      points.emplace_back(0.06 * i, random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05));
    }
    message.offsets.push_back(static_cast<std::uint32_t>(points.size()));
  }
  std::map<std::uint64_t, ros::Time> began;  // of touches that go on, at the latest
  std::map<PairKey, std::uint64_t> before;
  std::size_t told = 0;
  std::size_t parted = 0;
  ASSERT_NE(answer_to(crossed(0.1, z_)), nullptr);
  for (int frame = 0; frame < 60; ++frame) {
    SCOPED_TRACE("frame " + std::to_string(frame) + ", " + fiber::test::seed_message());
    message.points.clear();
    for (Vector3d& point : points) {
      point += Vector3d(0, random.uniform(-0.04, 0.04), random.uniform(-0.04, 0.04));
      point.tail<2>() *= 0.95;  // they stay together
      message.points.push_back(fiber_proximity_ros::to_message(point));
    }
    const ContactArray* const answer = answer_to(message);
    ASSERT_NE(answer, nullptr);
    ASSERT_EQ(answer->continuous, frame > 0);
    std::set<PairKey> standing;
    std::map<PairKey, std::uint64_t> now;
    std::map<std::uint64_t, ros::Time> first_of;  // by id, when it first was there at the latest
    std::set<std::uint64_t> passed;
    for (const Contact& contact : answer->contacts) {
      if (contact.gone) {
        passed.insert(contact.id);
      } else {
        standing.insert(key_of(contact));
        now[key_of(contact)] = contact.id;
      }
      const auto known = first_of.emplace(contact.id, contact.time_upper).first;
      known->second = std::min(known->second, contact.time_upper);
    }
    const std::map<PairKey, int> patches = patches_of(standing);
    std::map<std::uint64_t, int> patch_of;
    std::map<int, std::uint64_t> id_of;
    for (const auto& [pair, id] : now) {
      EXPECT_EQ(patch_of.emplace(id, patches.at(pair)).first->second, patches.at(pair))
          << "an id in two places";
      EXPECT_EQ(id_of.emplace(patches.at(pair), id).first->second, id) << "two ids in one place";
    }
    for (const auto& [pair, id] : now) {
      const auto old = before.find(pair);
      if (old != before.end() && old->second != id) {
        parted += id > old->second ? 1 : 0;
        EXPECT_TRUE(id < old->second || patch_of.count(old->second) > 0)
            << "a pair that stayed has another touch, though its own is nowhere";
      }
    }
    // As many events as follow from the ids: what is new began, what is no more has ended.
    std::size_t expected_events = 0;
    std::set<std::uint64_t> ids = passed;
    for (const auto& [id, patch] : patch_of) {
      ids.insert(id);
    }
    for (const std::uint64_t id : ids) {
      expected_events += began.count(id) == 0 ? 1 : 0;
      expected_events += patch_of.count(id) == 0 ? 1 : 0;
    }
    for (const auto& [id, time] : began) {
      expected_events += ids.count(id) == 0 ? 1 : 0;
    }
    std::vector<ContactEvent> events;
    ASSERT_TRUE(node_test::wait_for([&] {
      events.clear();
      for (const auto& event : events_.messages) {
        if (event->header.stamp == answer->header.stamp) {
          events.push_back(*event);
        }
      }
      return events.size() >= expected_events;
    }));
    ASSERT_EQ(events.size(), frame > 0 ? expected_events : events.size());
    for (const ContactEvent& event : events) {
      ++told;
      if (event.kind == ContactEvent::BEGAN) {
        EXPECT_TRUE(began.emplace(event.id, event.time_upper).second);
        ASSERT_EQ(first_of.count(event.id), 1U) << "nothing of it is in the answer";
        if (answer->continuous) {
          EXPECT_GE(event.time_upper, first_of[event.id]);
        }
      } else if (frame > 0) {
        EXPECT_EQ(began.erase(event.id), 1U);
      }
      EXPECT_LE(event.time_lower, event.time_upper);
      EXPECT_LE(event.time_upper, answer->header.stamp);
    }
    for (const Contact& contact : answer->contacts) {
      if (!contact.gone) {
        ASSERT_EQ(began.count(contact.id), 1U) << "it has not begun";
        EXPECT_NEAR(contact.age, (answer->header.stamp - began[contact.id]).toSec(), 1e-9);
      }
    }
    before = std::move(now);
  }
  fiber::test::expect_enough(told, std::size_t{100});
  fiber::test::expect_enough(parted, std::size_t{3});
}

}  // namespace
