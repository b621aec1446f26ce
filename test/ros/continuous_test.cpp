// The running node with ~continuous: what happens between two messages.
#include <cmath>
#include <set>

#include "fiber_proximity/ApplyObstacles.h"
#include "test/ros/continuous_fixture.hpp"

namespace {

using namespace continuous_test;  // NOLINT(google-build-using-namespace)

TEST_F(ContinuousTest, ACableThatPassesThroughAnotherBetweenMessagesIsTold) {
  const ContactArray* const answer = answer_to(crossed(0.1, -z_));
  ASSERT_NE(answer, nullptr);
  EXPECT_TRUE(answer->continuous);
  EXPECT_EQ(answer->since, answer->header.stamp - frame_time);
  ASSERT_EQ(answer->contacts.size(), 1U);
  const Contact& contact = answer->contacts[0];
  EXPECT_TRUE(contact.gone);
  EXPECT_EQ(contact.fiber_a, 0U);
  EXPECT_EQ(contact.segment_a, 2U);
  EXPECT_EQ(contact.fiber_b, 1U);
  EXPECT_NEAR(contact.distance, 0.0, 1e-6);
  EXPECT_NEAR(contact.point_a.x, 0.1, 1e-9);
  // 0.2 m in a tenth of a second; the surfaces meet when the axes are 2 mm apart.
  const double begin = (0.1 - 2 * radius) / 2.0;
  const double end = (0.1 + 2 * radius) / 2.0;
  EXPECT_LE(after(contact.time_lower, *answer), begin + 1e-9);
  EXPECT_GE(after(contact.time_upper, *answer), begin - 1e-9);
  EXPECT_LT((contact.time_upper - contact.time_lower).toSec(), 1e-5);

  const std::vector<ContactEvent> events = events_until(answer->header.stamp, 2);
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].kind, ContactEvent::BEGAN);
  EXPECT_EQ(events[1].kind, ContactEvent::ENDED);
  for (const ContactEvent& event : events) {
    const double expected = event.kind == ContactEvent::BEGAN ? begin : end;
    EXPECT_EQ(event.id, contact.id);
    EXPECT_EQ(event.body_a, "along");
    EXPECT_EQ(event.body_b, "across");
    EXPECT_EQ(event.segment_a, 2U);
    EXPECT_LE(after(event.time_lower, *answer), expected + 1e-9);
    EXPECT_GE(after(event.time_upper, *answer), expected - 1e-9);
    EXPECT_LT((event.time_upper - event.time_lower).toSec(), 1e-5);
    EXPECT_NEAR(event.deepest_gap, 0.0, 1e-6);
  }
  EXPECT_NEAR(events[1].duration, end - begin, 2e-5);
  // It stands still: nothing more happens.
  const ContactArray* const next = answer_to(crossed(0.1, -z_));
  ASSERT_NE(next, nullptr);
  EXPECT_TRUE(next->continuous);
  EXPECT_TRUE(next->contacts.empty());
}

TEST_F(ContinuousTest, WithoutItOnlyWhatIsThereIsTold) {
  set("continuous", false);
  const ContactArray* const answer = answer_to(crossed(0.1, -z_));
  ASSERT_NE(answer, nullptr);
  EXPECT_FALSE(answer->continuous);
  EXPECT_EQ(answer->since, answer->header.stamp);
  EXPECT_TRUE(answer->contacts.empty());
  set("continuous", true);
  const ContactArray* const first = answer_to(crossed(0.1, z_));
  ASSERT_NE(first, nullptr);
  EXPECT_FALSE(first->continuous) << "the fibres before were not kept";
  const ContactArray* const second = answer_to(crossed(0.1, -z_));
  ASSERT_NE(second, nullptr);
  EXPECT_EQ(second->contacts.size(), 1U);
}

TEST_F(ContinuousTest, AContactKeepsItsIdAsItSlidesAlong) {
  const ContactArray* answer = answer_to(crossed(-0.4, 0.0));
  ASSERT_NE(answer, nullptr);
  ASSERT_FALSE(answer->contacts.empty());
  const std::uint64_t id = answer->contacts[0].id;
  EXPECT_GT(id, 0U);
  const std::vector<ContactEvent> began = events_until(answer->header.stamp, 1);
  ASSERT_EQ(began.size(), 1U);
  EXPECT_EQ(began[0].kind, ContactEvent::BEGAN);
  std::set<std::uint32_t> segments;
  double age = -1.0;
  for (double x = -0.35; x < 0.41; x += 0.05) {
    answer = answer_to(crossed(x, 0.0));
    ASSERT_NE(answer, nullptr);
    ASSERT_FALSE(answer->contacts.empty());
    for (const Contact& contact : answer->contacts) {
      EXPECT_EQ(contact.id, id);
      EXPECT_GT(contact.age, age);
      segments.insert(contact.segment_a);
    }
    age = answer->contacts[0].age;
  }
  EXPECT_EQ(segments.size(), 4U);
  EXPECT_GT(age, 1.4);
  answer = answer_to(crossed(0.4, z_));
  ASSERT_NE(answer, nullptr);
  EXPECT_TRUE(answer->contacts.empty()) << "it was there before, and in the answer before";
  const std::vector<ContactEvent> ended = events_until(answer->header.stamp, 1);
  ASSERT_EQ(ended.size(), 1U);
  EXPECT_EQ(ended[0].kind, ContactEvent::ENDED);
  EXPECT_EQ(ended[0].id, id);
  EXPECT_NEAR(after(ended[0].time_lower, *answer), 2 * radius, 1e-4);  // of 0.1 m in 0.1 s
  EXPECT_NEAR(ended[0].deepest_gap, -2 * radius, 1e-9);
  EXPECT_NEAR(ended[0].duration, 1.7, 0.11);
}

TEST_F(ContinuousTest, GradientsAreThoseOfTheContact) {
  const ContactArray* const answer = answer_to(crossed(0.1, 1e-3));
  ASSERT_NE(answer, nullptr);
  ASSERT_EQ(answer->contacts.size(), 1U);
  const Contact& contact = answer->contacts[0];
  ASSERT_EQ(contact.gradients.size(), 4U);
  // The cable across is above: its ends up, the distance up.
  EXPECT_NEAR(contact.gradients[0].z, -(1 - contact.s), 1e-12);
  EXPECT_NEAR(contact.gradients[1].z, -contact.s, 1e-12);
  EXPECT_NEAR(contact.gradients[2].z, 0.5, 1e-12);
  EXPECT_NEAR(contact.gradients[3].z, 0.5, 1e-12);
  ASSERT_TRUE(answer->has_minimum);
  EXPECT_EQ(answer->minimum.gradients.size(), 4U);
  set("gradients", false);
  const ContactArray* const without = answer_to(crossed(0.1, 1e-3));
  set("gradients", true);
  ASSERT_NE(without, nullptr);
  EXPECT_TRUE(without->contacts[0].gradients.empty());
}

/// A plate between two states, and a ball that moves while the cables stand still.
TEST_F(ContinuousTest, WhatIsAroundIsMetBetweenMessages) {
  node_test::Recorder<ContactArray> around(node, "/proximity/environment_contacts");
  const auto apply = [](const fiber_proximity::Obstacle& obstacle) {
    fiber_proximity::ApplyObstacles service;
    service.request.obstacles = {obstacle};
    ASSERT_TRUE(node_test::call_service("/proximity/apply_obstacles", service));
    ASSERT_TRUE(service.response.success) << service.response.message;
  };
  apply(plate({0.1, 0.2, 0.05 * z_ / 0.1}));
  ASSERT_TRUE(node_test::wait_for([&] {
    return answer_to(crossed(0.1, z_)) != nullptr && !around.messages.empty() &&
           around.messages.back()->continuous;
  }));
  events_.messages.clear();
  const ros::Time stamp = publish(crossed(0.1, -z_));
  const ContactArray* const met = around.wait_for(stamp);
  ASSERT_NE(met, nullptr);
  EXPECT_TRUE(met->continuous);
  ASSERT_EQ(met->contacts.size(), 1U);
  EXPECT_TRUE(met->contacts[0].gone);
  EXPECT_EQ(met->contacts[0].type_b, Contact::OBJECT);
  EXPECT_EQ(met->contacts[0].fiber_a, 1U);
  EXPECT_NEAR(met->contacts[0].distance, 0.0, 2e-6);
  const double expected = (0.1 - 0.05 - 0.0005 - radius) / 2.0;
  EXPECT_LE(after(met->contacts[0].time_lower, *met), expected + 1e-9);
  EXPECT_GE(after(met->contacts[0].time_upper, *met), expected - 1e-9);
  EXPECT_LT((met->contacts[0].time_upper - met->contacts[0].time_lower).toSec(), 1e-4);
  std::vector<ContactEvent> of_plate;
  for (const ContactEvent& event : events_until(stamp, 4)) {
    if (event.type_b == Contact::OBJECT) {
      of_plate.push_back(event);
    }
  }
  ASSERT_EQ(of_plate.size(), 2U);
  EXPECT_EQ(of_plate[0].kind, ContactEvent::BEGAN);
  EXPECT_EQ(of_plate[0].body_b, "plate");
  EXPECT_EQ(of_plate[1].kind, ContactEvent::ENDED);
  EXPECT_EQ(of_plate[0].id, met->contacts[0].id);

  // Towards the plate, whose side the cable is on now, it is predicted.
  const double side = z_ > 0.0 ? 1.0 : -1.0;
  apply(plate({0.1, 0.2, -0.2 * side}));
  ASSERT_NE(answer_to(crossed(0.1, -z_)), nullptr);
  ASSERT_NE(answer_to(crossed(0.1, -z_ - 0.01 * side)), nullptr);
  const TimeToContact* const told = times_.wait_for(publish(crossed(0.1, -z_ - 0.02 * side)));
  ASSERT_NE(told, nullptr);
  ASSERT_TRUE(told->environment.expected);
  EXPECT_EQ(told->object_names, std::vector<std::string>{"plate"});
  EXPECT_LT(told->environment.time_lower, told->environment.time_upper);
  EXPECT_NEAR(told->environment.time_upper, (0.08 - 0.0005 - radius) / 0.1, 1e-3);

  // The plate itself goes through the cable that stands still.
  ASSERT_NE(answer_to(crossed(0.1, -z_)), nullptr);
  ASSERT_NE(answer_to(crossed(0.1, -z_)), nullptr);
  around.messages.clear();
  apply(plate({0.1, 0.2, 0.3 * side}));
  ASSERT_TRUE(node_test::wait_for([&] {
    answer_to(crossed(0.1, -z_));
    return around.find([](const ContactArray& answer) {
      return answer.contacts.size() == 1 && answer.contacts[0].gone;
    }) != nullptr;
  }));
}

/// The other input stays, ahead of the cables: in a process of its own after the others.
class ContinuousInputsTest : public ContinuousTest {};

TEST_F(ContinuousInputsTest, TheOtherInputStandsStill) {
  const ros::Publisher others = advertise<FiberArray>("/other");
  FiberArray still =
      test_messages::fiber_array(test_messages::header("world"), {{0, 0, 0.3}, {0.4, 0.4, 0.3}});
  still.header.stamp = ros::Time::now() - ros::Duration(9000);  // ahead of the cables
  others.publish(still);
  ASSERT_NE(contacts.wait_for(still.header.stamp), nullptr);
  ASSERT_TRUE(
      node_test::wait_for([&] { return contacts.messages.back()->fiber_names.size() == 3; }));
  const std::size_t count = contacts.messages.size();
  const auto next_answer = [&](std::size_t number) {
    EXPECT_TRUE(node_test::wait_for([&] { return contacts.messages.size() > count + number; }));
    return contacts.messages[count + number];
  };
  const ros::Time stamp = publish(crossed(0.1, -z_));
  const auto answer = next_answer(0);
  EXPECT_TRUE(answer->continuous);
  EXPECT_EQ(answer->header.stamp, still.header.stamp) << "the newest of all";
  EXPECT_EQ(answer->since, stamp - frame_time) << "that of what has moved";
  ASSERT_EQ(answer->contacts.size(), 1U);
  EXPECT_LT(answer->contacts[0].time_upper, stamp);
  FiberArray gone = still;  // fibres that leave do not stop the others
  gone.header.stamp += ros::Duration(0.01);
  gone.points.push_back(fiber_proximity_ros::to_message(Vector3d(0.5, 0.5, 0.3)));
  gone.offsets = {0, 3};
  others.publish(gone);
  EXPECT_FALSE(next_answer(1)->continuous);
  publish(crossed(0.1, z_));
  EXPECT_TRUE(next_answer(2)->continuous);
  EXPECT_EQ(next_answer(2)->contacts.size(), 1U);
}

}  // namespace
