// The running node and what is around its fibres: ~environment_contacts, ~query and ~check_fibers.
#include <limits>

#include "fiber_proximity/ApplyObstacles.h"
#include "fiber_proximity/CheckFibers.h"
#include "fiber_proximity/QueryProximity.h"
#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

namespace {

using fiber_proximity::ApplyObstacles;
using fiber_proximity::CheckFibers;
using fiber_proximity::Contact;
using fiber_proximity::ContactArray;
using fiber_proximity::FiberArray;
using fiber_proximity::Obstacle;
using fiber_proximity::QueryProximity;
using test_messages::ball;
using test_messages::header;

/// Along z, at x, of radius 0.01.
FiberArray upright(double x) {
  FiberArray fiber =
      test_messages::fiber_array(header("world"), {{x, 0, -1}, {x, 0, 0.5}, {x, 0, 1}});
  fiber.radii = {0.01};
  return fiber;
}

template <class Service>
typename Service::Response call(const std::string& name, const typename Service::Request& request) {
  Service service;
  service.request = request;
  EXPECT_TRUE(node_test::call_service(name, service));
  return service.response;
}

class EnvironmentTest : public node_test::NodeTest {
 protected:
  void SetUp() override {
    publisher_ = advertise<FiberArray>("fibers");
    connect(publisher_, upright(0.0));
    apply({remove_all()});
  }

  static Obstacle remove_all() {
    Obstacle obstacle;
    obstacle.header.frame_id = "world";
    obstacle.operation = Obstacle::REMOVE;
    return obstacle;
  }

  static void apply(const std::vector<Obstacle>& obstacles) {
    ApplyObstacles::Request request;
    request.obstacles = obstacles;
    const ApplyObstacles::Response response =
        call<ApplyObstacles>("/proximity/apply_obstacles", request);
    EXPECT_TRUE(response.success) << response.message;
  }

  ros::Time send(double x) {
    FiberArray message = upright(x);
    message.header.stamp = new_stamp();
    publisher_.publish(message);
    return message.header.stamp;
  }

  static CheckFibers::Response check(const std::vector<FiberArray>& candidates, double margin = 0.0,
                                     std::uint8_t type = CheckFibers::Request::ALL) {
    CheckFibers::Request request;
    request.type = type;
    request.margin = margin;
    request.candidates = candidates;
    return call<CheckFibers>("/proximity/check_fibers", request);
  }

  ros::Publisher publisher_;
};

TEST_F(EnvironmentTest, ContactsNameObjectShapeAndSegment) {
  node_test::Recorder<ContactArray> environment(node, "/proximity/environment_contacts");
  apply({ball("near", 0.5, 0.45), ball("far", -2.0, 1.0)});
  connect(publisher_, upright(0.0), [&] { return !environment.messages.empty(); });
  const ContactArray* answer = environment.wait_for(send(0.0));
  ASSERT_NE(answer, nullptr);
  EXPECT_EQ(answer->header.frame_id, "world");
  EXPECT_EQ(answer->object_names, (std::vector<std::string>{"far", "near"}));
  ASSERT_EQ(answer->contacts.size(), 1U);  // within the margin of 0.05
  const Contact& contact = answer->contacts[0];
  EXPECT_EQ(contact.type_a, Contact::FIBER);
  EXPECT_EQ(contact.type_b, Contact::OBJECT);
  EXPECT_EQ(contact.fiber_b, 1U);
  EXPECT_EQ(contact.segment_b, 0U);
  EXPECT_EQ(contact.segment_a, 0U);
  EXPECT_NEAR(contact.s, 2.0 / 3.0, 1e-9);
  EXPECT_NEAR(contact.distance, 0.04, 1e-12);
  EXPECT_NEAR(contact.normal.x, 1.0, 1e-9);
  EXPECT_LE(contact.lower, contact.distance);
  EXPECT_GE(contact.upper, contact.distance);
  EXPECT_TRUE(answer->has_minimum);
  EXPECT_EQ(answer->minimum_distance, contact.distance);
  // Within reach of nothing the closest pair is told all the same; where an object goes, too.
  answer = environment.wait_for(send(-0.5));
  ASSERT_NE(answer, nullptr);
  EXPECT_TRUE(answer->contacts.empty());
  EXPECT_NEAR(answer->minimum_distance, 0.49, 1e-12);
  Obstacle moved = ball("far", -1.5, 1.0);
  moved.primitives.clear();
  moved.primitive_poses.clear();
  moved.operation = Obstacle::MOVE;
  apply({moved});
  answer = environment.wait_for(send(-0.5));
  ASSERT_NE(answer, nullptr);
  ASSERT_EQ(answer->contacts.size(), 1U);
  EXPECT_NEAR(answer->contacts[0].distance, -0.01, 1e-12);
}

/// Whoever listens would believe that the last contact lasted.
TEST_F(EnvironmentTest, TellsThatTheLastObjectHasGone) {
  node_test::Recorder<ContactArray> environment(node, "/proximity/environment_contacts");
  apply({ball("ball", 0.0, 0.3)});
  const ContactArray* answer = environment.wait_for(send(0.0));
  ASSERT_NE(answer, nullptr);
  EXPECT_EQ(answer->contacts.size(), 1U);
  // With fibres on their way, as a tracker sends them.
  Obstacle removal = ball("ball", 0.0, 0.3);
  removal.operation = Obstacle::REMOVE;
  const std::size_t before = environment.messages.size();
  apply({removal});
  send(0.0);
  EXPECT_TRUE(node_test::wait_for([&] {
    return environment.messages.size() > before && environment.messages.back()->contacts.empty();
  }));
}

TEST_F(EnvironmentTest, IsNotLookedAtWhereThereIsNone) {
  const fiber_proximity::Statistics* cost = statistics.wait_for(send(0.0));
  ASSERT_NE(cost, nullptr);
  EXPECT_EQ(cost->parts,
            (std::vector<std::string>{"merge", "update", "contacts", "minimum", "touches"}));
  ASSERT_EQ(cost->part_times.size(), 5U);
  EXPECT_EQ(cost->objects, 0U);
  apply({ball("ball", 0.0, 0.3)});
  cost = statistics.wait_for(send(0.0));
  ASSERT_NE(cost, nullptr);
  EXPECT_EQ(cost->parts, (std::vector<std::string>{"merge", "update", "contacts", "minimum",
                                                   "touches", "environment_update",
                                                   "environment_contacts", "environment_minimum"}));
  EXPECT_EQ(cost->objects, 1U);
  EXPECT_EQ(cost->environment_contacts, 1U);
}

TEST_F(EnvironmentTest, AnswersQueriesAboutFibresObjectsAndBoth) {
  apply({ball("ball", 1.0, 0.25)});
  QueryProximity::Request request;
  request.type = QueryProximity::Request::ALL;
  request.margin = 10.0;
  request.shapes.resize(1);
  request.shapes[0].points.resize(1);
  request.shapes[0].points[0].x = 0.5;
  const auto ask = [&](std::uint8_t against) {
    request.against = against;
    QueryProximity::Response response = call<QueryProximity>("/proximity/query", request);
    EXPECT_TRUE(response.success) << response.message;
    return response;
  };
  QueryProximity::Response response = ask(QueryProximity::Request::ENVIRONMENT);
  ASSERT_EQ(response.contacts.size(), 1U);
  EXPECT_EQ(response.contacts[0].type_a, Contact::SHAPE);
  EXPECT_EQ(response.contacts[0].type_b, Contact::OBJECT);
  EXPECT_EQ(response.object_names.at(response.contacts[0].fiber_b), "ball");
  EXPECT_NEAR(response.contacts[0].distance, 0.25, 1e-12);
  response = ask(QueryProximity::Request::FIBERS);
  ASSERT_EQ(response.contacts.size(), 2U);
  EXPECT_EQ(response.contacts[0].type_b, Contact::FIBER);
  response = ask(QueryProximity::Request::EVERYTHING);
  ASSERT_EQ(response.contacts.size(), 3U);
  EXPECT_EQ(response.contacts[1].type_b, Contact::FIBER);
  EXPECT_EQ(response.contacts[2].type_b, Contact::OBJECT);
  EXPECT_EQ(response.contacts[2].fiber_b, 0U);
  request.type = QueryProximity::Request::CLOSEST;
  response = ask(QueryProximity::Request::EVERYTHING);
  ASSERT_EQ(response.contacts.size(), 1U);
  EXPECT_EQ(response.contacts[0].type_b, Contact::OBJECT);
  request.against = 3;
  response = call<QueryProximity>("/proximity/query", request);
  EXPECT_FALSE(response.success);
  EXPECT_EQ(response.message.find("against is 3, it must be 0 (FIBERS), 1"), 0U);
}

TEST_F(EnvironmentTest, ChecksHypotheticalFibres) {
  apply({ball("ball", 1.0, 0.25)});
  FiberArray loop = upright(3.0);  // touches itself
  loop.offsets = {0, 4};
  loop.points.resize(4);
  for (int i = 0; i < 4; ++i) {
    loop.points[static_cast<std::size_t>(i)].x = i < 2 ? 3.0 : 3.015;
    loop.points[static_cast<std::size_t>(i)].z = i == 1 || i == 2 ? 1.0 : 0.0;
  }
  const CheckFibers::Response response = check({upright(0.5), upright(0.9), upright(0.015), loop});
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ(response.free, (std::vector<std::uint8_t>{1, 0, 0, 0}));
  EXPECT_EQ(response.complete, (std::vector<std::uint8_t>{1, 1, 1, 1}));
  ASSERT_EQ(response.offsets.size(), 5U);
  EXPECT_EQ(response.offsets[1], 0U);
  const Contact& with_ball = response.contacts.at(response.offsets[1]);
  EXPECT_EQ(with_ball.type_a, Contact::CANDIDATE);
  EXPECT_EQ(with_ball.type_b, Contact::OBJECT);
  EXPECT_NEAR(with_ball.distance, -0.16, 1e-12);
  EXPECT_EQ(response.contacts.at(response.offsets[2]).type_b, Contact::FIBER);
  EXPECT_NEAR(response.contacts.at(response.offsets[2]).distance, -0.005, 1e-12);
  EXPECT_EQ(response.contacts.at(response.offsets[3]).type_b, Contact::CANDIDATE);
  EXPECT_EQ(check({upright(0.5)}, 0.3).free, (std::vector<std::uint8_t>{0}));
}

TEST_F(EnvironmentTest, ChecksManyAtOnceForTheirFirstContact) {
  apply({ball("ball", 1.0, 0.25)});
  std::vector<FiberArray> candidates;
  for (int i = 0; i < 1000; ++i) {
    candidates.push_back(upright(0.101 + 2e-3 * i));
  }
  const CheckFibers::Response response = check(candidates, 0.0, CheckFibers::Request::FIRST);
  ASSERT_TRUE(response.success) << response.message;
  ASSERT_EQ(response.free.size(), 1000U);
  for (std::size_t i = 0; i < 1000; ++i) {
    const double x = 0.101 + 2e-3 * static_cast<double>(i);
    EXPECT_EQ(response.free[i] != 0, std::abs(x - 1.0) > 0.26) << x;
    EXPECT_EQ(response.offsets[i + 1] - response.offsets[i], response.free[i] != 0 ? 0U : 1U);
  }
}

TEST_F(EnvironmentTest, ChecksLeaveOutWhatTheyAreToldTo) {
  apply({ball("ball", 0.0, 0.25)});
  CheckFibers::Request request;
  request.type = CheckFibers::Request::ALL;
  request.candidates = {upright(0.0)};
  const auto kinds = [&] {
    const CheckFibers::Response response = call<CheckFibers>("/proximity/check_fibers", request);
    EXPECT_TRUE(response.success) << response.message;
    std::vector<std::uint8_t> found;
    for (const Contact& contact : response.contacts) {
      if (found.empty() || found.back() != contact.type_b) {
        found.push_back(contact.type_b);
      }
    }
    return found;
  };
  EXPECT_EQ(kinds(), (std::vector<std::uint8_t>{Contact::FIBER, Contact::OBJECT}));
  request.ignore_environment = 1;
  EXPECT_EQ(kinds(), (std::vector<std::uint8_t>{Contact::FIBER}));
  request.replaced_fibers = {"fibers"};
  EXPECT_TRUE(kinds().empty());
}

TEST_F(EnvironmentTest, SaysWhichCandidateIsWrong) {
  const auto refusal = [](const std::vector<FiberArray>& candidates) {
    const CheckFibers::Response response = check(candidates);
    EXPECT_FALSE(response.success);
    EXPECT_TRUE(response.free.empty());
    return response.message;
  };
  FiberArray bad = upright(0.0);
  bad.radii.clear();
  EXPECT_EQ(refusal({upright(1.0), bad}).find("candidate 1: has no radii"), 0U);
  bad = upright(0.0);
  bad.points[1].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal({bad}).find("candidate 0: fibre 0, point 1"), 0U) << refusal({bad});
  bad = upright(0.0);
  bad.header.frame_id = "nowhere";
  EXPECT_EQ(refusal({bad}).find("candidate 0: "), 0U);
  CheckFibers::Request request;
  request.replaced_fibers = {"hose"};
  const CheckFibers::Response response = call<CheckFibers>("/proximity/check_fibers", request);
  EXPECT_EQ(response.message, "there is no fibre 'hose' to be replaced");
  // Of two with one name nobody knows which one is meant.
  FiberArray twins = upright(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    twins.points.push_back(twins.points[i]);
    twins.points.back().x += 1.0;
  }
  twins.offsets = {0, 3, 6};
  twins.names = {"twin", "twin"};
  request.replaced_fibers = {"twin"};
  EXPECT_TRUE(node_test::wait_for([&] {
    twins.header.stamp = new_stamp();
    publisher_.publish(twins);
    return call<CheckFibers>("/proximity/check_fibers", request).message ==
           "which of the 2 fibres with the name 'twin' is to be replaced is not known: each must "
           "have its own";
  }));
  request.replaced_fibers.clear();
  request.margin = -1.0;
  EXPECT_FALSE(call<CheckFibers>("/proximity/check_fibers", request).success);
}

}  // namespace
