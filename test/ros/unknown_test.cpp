// Sources that fail: whatever is unknown, no answer is complete and nothing is free of it, while
// all that does not depend on it is answered as ever.
#include "fiber_proximity/AllowPairs.h"
#include "test/ros/unknown_fixture.hpp"

namespace {

using namespace unknown_test;  // NOLINT(google-build-using-namespace)

// First of its suite.
TEST_F(UnknownTest, WhatNeverCameIsUnknownUntilItComes) {
  // Topics of obstacles cannot say which obstacles are to come.
  const auto rename = [this](const std::string& from, const std::string& to) {
    for (Source& source : sources_) {
      source.name = source.name == from ? to : source.name;
    }
  };
  rename("bodies/0", "obstacles of /bodies");
  rename("ball", "obstacles of /proximity/obstacles");
  std::vector<const Source*> lacking;
  for (const Source& source : sources_) {
    lacking.push_back(&source);
  }
  expect(lacking);
  while (!lacking.empty()) {
    sources_[static_cast<std::size_t>(lacking.front() - sources_.data())].fault = Fault::NONE;
    lacking.erase(lacking.begin());
    SCOPED_TRACE(std::to_string(lacking.size()) + " to come");
    expect(lacking);
  }
}

TEST_F(UnknownTest, WhatFailsIsUnknownUntilItIsBack) {
  heal_all();
  for (Source& source : sources_) {
    for (const Fault fault : source.faults) {
      SCOPED_TRACE(source.name + ", " + name_of(fault));
      source.fault = fault;
      expect({&source});
      source.fault = Fault::NONE;
      expect({});
    }
  }
}

TEST_F(UnknownTest, WhereAllStopAListenerIsToldAgainAndAgain) {
  heal_all();
  std::vector<const Source*> lacking;
  for (Source& source : sources_) {
    if (source.is_of_fibers) {
      source.fault = Fault::SILENCE;
      lacking.push_back(&source);
    }
  }
  expect(lacking);
  const std::size_t contacts_before = contacts.messages.size();
  const std::size_t around_before = around_.messages.size();
  const std::size_t times_before = times_.messages.size();
  ASSERT_TRUE(node_test::wait_for([&] {
    return contacts.messages.size() > contacts_before + 3 &&
           around_.messages.size() > around_before + 3 && times_.messages.size() > times_before + 3;
  })) << "though nothing was sent";
  EXPECT_EQ(problem(lacking), "");
  EXPECT_FALSE(contacts.messages.back()->has_minimum);
  EXPECT_TRUE(contacts.messages.back()->fiber_names.empty());
}

TEST_F(UnknownTest, ARefusedObstacleIsOwedUntilALaterChangeSettlesIt) {
  heal_all();
  Source& ball = sources_[5];
  ASSERT_EQ(ball.name, "ball");
  ball.fault = Fault::REFUSED;
  expect({&ball});
  ball.fault = Fault::SILENCE;
  expect({&ball});  // nobody has taken it back
  ObstacleArray removal;
  removal.obstacles.resize(1);
  removal.obstacles[0].id = "ball";
  removal.obstacles[0].operation = fiber_proximity::Obstacle::REMOVE;
  obstacles_.publish(removal);
  expect({});
  obstacles_.publish(removal);  // refused, as it is not there: that is what was wanted
  expect({});
}

TEST_F(UnknownTest, WhatEveryFibreMayTouchIsNotAskedAbout) {
  heal_all();
  Source& link = sources_[2];
  ASSERT_EQ(link.name, "robot/tool");
  link.fault = Fault::SILENCE;
  expect({&link});
  fiber_proximity::AllowPairs service;
  service.request.allow.resize(1);
  service.request.allow[0].object = "robot/tool";
  ASSERT_TRUE(node_test::call_service("/proximity/allow_pairs", service));
  ASSERT_TRUE(node_test::wait_for([&] {
    step();
    return !around_.messages.empty() && around_.messages.back()->complete != 0;
  }));
  EXPECT_NE(check(false, true, false).free[0], 0);
  EXPECT_EQ(query(QueryProximity::Request::ENVIRONMENT).complete, 0) << "shapes may touch nothing";
  service.request = {};
  service.request.reset = true;
  ASSERT_TRUE(node_test::call_service("/proximity/allow_pairs", service));
  expect({&link});
}

}  // namespace
