#include "src/rviz/contact_pairing.hpp"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>

namespace fiber_proximity_rviz {
namespace {

constexpr double frame = 1.0 / 30.0;  // [s] between two calls of take()

fiber_proximity::FiberArrayConstPtr fibers(double stamp) {
  auto message = boost::make_shared<fiber_proximity::FiberArray>();
  message->header.stamp = ros::Time(stamp);
  return message;
}

fiber_proximity::ContactArrayConstPtr contacts(double stamp) {
  auto message = boost::make_shared<fiber_proximity::ContactArray>();
  message->header.stamp = ros::Time(stamp);
  return message;
}

TEST(ContactPairing, NothingIsReadyAtFirst) {
  ContactPairing pairing;
  EXPECT_EQ(pairing.take(10.0).fibers, nullptr);
  pairing.add(contacts(1.0));
  EXPECT_EQ(pairing.take(10.0).fibers, nullptr);
}

TEST(ContactPairing, EqualStampsMatchInEitherOrderOnce) {
  for (const bool fibers_first : {true, false}) {
    ContactPairing pairing;
    const auto some_fibers = fibers(1.0);
    const auto some_contacts = contacts(1.0);
    if (fibers_first) {
      pairing.add(some_fibers);
      EXPECT_EQ(pairing.take(frame).fibers, nullptr);
      pairing.add(some_contacts);
    } else {
      pairing.add(some_contacts);
      EXPECT_EQ(pairing.take(frame).fibers, nullptr);
      pairing.add(some_fibers);
    }
    const FibersAndContacts ready = pairing.take(frame);
    EXPECT_EQ(ready.fibers, some_fibers);
    EXPECT_EQ(ready.contacts, some_contacts);
    EXPECT_EQ(pairing.take(frame).fibers, nullptr);
  }
}

TEST(ContactPairing, NewerFibersDoNotHideAMatch) {
  ContactPairing pairing;
  const auto matched = fibers(1.0);
  pairing.add(matched);
  pairing.add(contacts(1.0));
  pairing.add(fibers(2.0));
  EXPECT_EQ(pairing.take(frame).fibers, matched);
  EXPECT_EQ(pairing.take(frame).fibers, nullptr);
}

TEST(ContactPairing, FibersDoNotWaitForever) {
  ContactPairing pairing;
  const auto lonely = fibers(2.0);
  pairing.add(contacts(1.0));
  pairing.add(lonely);
  double waited = 0.0;
  FibersAndContacts ready;
  while (!ready.fibers) {
    ready = pairing.take(frame);
    waited += frame;
    ASSERT_LT(waited, 1.0);
  }
  EXPECT_GT(waited, ContactPairing::timeout);
  EXPECT_EQ(ready.fibers, lonely);
  EXPECT_EQ(ready.contacts, nullptr);

  // Nor do those that follow, until contacts are there again.
  const auto next = fibers(3.0);
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(pairing.take(frame).fibers, nullptr);
  }
  pairing.add(next);
  EXPECT_EQ(pairing.take(frame).fibers, next);
  const auto late = contacts(3.0);
  pairing.add(late);
  ready = pairing.take(frame);
  EXPECT_EQ(ready.fibers, next);
  EXPECT_EQ(ready.contacts, late);
  pairing.add(fibers(4.0));
  EXPECT_EQ(pairing.take(frame).fibers, nullptr);
}

TEST(ContactPairing, ClearForgets) {
  ContactPairing pairing;
  pairing.add(fibers(1.0));
  pairing.add(contacts(1.0));
  pairing.clear();
  EXPECT_EQ(pairing.take(10.0).fibers, nullptr);
  pairing.add(contacts(1.0));
  EXPECT_EQ(pairing.take(10.0).fibers, nullptr);
}

}  // namespace
}  // namespace fiber_proximity_rviz
