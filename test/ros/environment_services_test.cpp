// The running node without a fixed frame: asked before there are any fibres, and with deadlines.
// The tests run in this order, before those of environment_updates_test.cpp.
#include <algorithm>
#include <random>

#include "fiber_proximity/CheckFibers.h"
#include "test/ros/environment_services_fixture.hpp"
#include "test/support/not_finite.hpp"

namespace {

using fiber_proximity::CheckFibers;
using fiber_proximity::Contact;
using fiber_proximity::FiberArray;
using fiber_proximity::QueryProximity;
using node_test::EnvironmentServicesTest;
using test_messages::ball;
using test_messages::header;

using fiber::test::infinity;

fiber_proximity::QueryShape shape(const Eigen::Vector3d& point, const std::string& frame) {
  fiber_proximity::QueryShape shape;
  shape.header.frame_id = frame;
  shape.points = {fiber_proximity_ros::to_message(point)};
  shape.radius = 0.01;
  return shape;
}

TEST_F(EnvironmentServicesTest, WithoutFibresTheEnvironmentIsAskedAboutAllTheSame) {
  QueryProximity::Request request;
  request.against = QueryProximity::Request::ENVIRONMENT;
  request.type = QueryProximity::Request::CLOSEST;
  request.margin = infinity;
  // No frame is known yet: only shapes that name one cannot be placed.
  request.shapes = {shape({1, 0, 0}, "")};
  QueryProximity::Response answer = query(request);
  ASSERT_TRUE(answer.success) << answer.message;
  EXPECT_TRUE(answer.complete);
  EXPECT_EQ(answer.offsets, (std::vector<std::uint32_t>{0, 0}));
  EXPECT_EQ(answer.minimum_lower, std::vector<double>{infinity});
  request.shapes = {shape({1, 0, 0}, "world")};
  answer = query(request);
  EXPECT_FALSE(answer.success);
  EXPECT_NE(answer.message.find("shape 0: no transform from frame 'world': there is no fixed frame "
                                "yet, set the parameter fixed_frame"),
            std::string::npos)
      << answer.message;

  apply({ball("ball", 0.0, 0.25)});  // its frame is the fixed one from now on
  answer = query(request);
  ASSERT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(answer.header.frame_id, "world");
  EXPECT_FALSE(answer.header.stamp.isZero());
  EXPECT_TRUE(answer.fiber_names.empty());
  EXPECT_EQ(answer.object_names, std::vector<std::string>{"ball"});
  ASSERT_EQ(answer.contacts.size(), 1U);
  EXPECT_NEAR(answer.contacts[0].distance, 0.74, 1e-12);

  // What is asked about fibres is refused still.
  for (const auto against :
       {QueryProximity::Request::FIBERS, QueryProximity::Request::EVERYTHING}) {
    request.against = against;
    answer = query(request);
    EXPECT_FALSE(answer.success);
    EXPECT_NE(answer.message.find("no fresh input"), std::string::npos) << answer.message;
  }
}

TEST_F(EnvironmentServicesTest, WithoutFibresCandidatesAreCheckedThatAreToIgnoreThem) {
  apply({ball("ball", 0.0, 0.25)});
  CheckFibers::Request request;
  request.type = CheckFibers::Request::ALL;
  request.candidates = {fiber(0.2, -1, 1), fiber(0.3, -1, 1)};
  request.replaced_fibers = {"none of them"};
  EXPECT_FALSE(call<CheckFibers>("check_fibers", request).success);
  request.ignore_fibers = true;
  const auto answer = call<CheckFibers>("check_fibers", request);
  ASSERT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(answer.free, (std::vector<std::uint8_t>{0, 1}));
  EXPECT_EQ(answer.complete, (std::vector<std::uint8_t>{1, 1}));
  ASSERT_GE(answer.contacts.size(), 1U);
  EXPECT_EQ(answer.contacts[0].type_b, Contact::OBJECT);
}

TEST_F(EnvironmentServicesTest, ADeadlineIsThatOfTheWholeBatch) {
  const ros::Publisher publisher = advertise<FiberArray>("fibers");
  connect(publisher, fiber(0.4, -1, 1));
  apply({ball("ball", 0.0, 0.25)});
  std::mt19937 random(16);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  QueryProximity::Request request;
  request.type = QueryProximity::Request::CLOSEST;
  request.margin = infinity;
  for (int i = 0; i < 3000; ++i) {
    request.shapes.push_back(
        shape({coordinate(random), coordinate(random), coordinate(random)}, "world"));
  }
  for (const auto against : {QueryProximity::Request::FIBERS, QueryProximity::Request::ENVIRONMENT,
                             QueryProximity::Request::EVERYTHING}) {
    request.against = against;
    request.deadline = 0.0;
    const QueryProximity::Response truth = query(request);
    ASSERT_TRUE(truth.success) << truth.message;
    EXPECT_TRUE(truth.complete);
    ASSERT_EQ(truth.contacts.size(), request.shapes.size());
    for (const double deadline : {1e-9, 1e-4, 1e-3}) {
      request.deadline = deadline;
      const QueryProximity::Response answer = query(request);
      ASSERT_TRUE(answer.success) << answer.message;
      ASSERT_EQ(answer.offsets.size(), request.shapes.size() + 1);
      ASSERT_EQ(answer.minimum_lower.size(), request.shapes.size());
      EXPECT_EQ(answer.offsets.back(), answer.contacts.size());
      std::size_t unknown = 0;
      for (std::size_t i = 0; i < request.shapes.size(); ++i) {
        EXPECT_LE(answer.minimum_lower[i], truth.contacts[i].upper);
        if (answer.offsets[i + 1] == answer.offsets[i]) {
          EXPECT_EQ(answer.minimum_lower[i], -infinity);
          ++unknown;
        } else {
          EXPECT_EQ(answer.contacts[answer.offsets[i]].fiber_a, i);
          EXPECT_GE(answer.contacts[answer.offsets[i]].upper, truth.contacts[i].lower);
        }
      }
      EXPECT_TRUE(!answer.complete || unknown == 0);
      if (deadline == 1e-9) {
        EXPECT_FALSE(answer.complete);
        EXPECT_EQ(unknown, request.shapes.size());
      }
    }
  }
}

TEST_F(EnvironmentServicesTest, ShapesTheDeadlineComesBeforeAreNotRead) {
  apply({ball("ball", 0.0, 0.25)});
  QueryProximity::Request request;
  request.against = QueryProximity::Request::ENVIRONMENT;
  request.type = QueryProximity::Request::CLOSEST;
  request.margin = infinity;
  // No machine reads a million points in a millisecond, and the one after it cannot be read.
  request.shapes = {shape({1, 0, 0}, "world"), shape({1, 0, 0}, "world")};
  request.shapes[0].points.resize(1'000'000);
  request.shapes[1].points.clear();
  const QueryProximity::Response refusal = query(request);
  EXPECT_FALSE(refusal.success);
  EXPECT_NE(refusal.message.find("shape 1: has no points"), std::string::npos) << refusal.message;

  request.deadline = 1e-3;
  const QueryProximity::Response answer = query(request);
  ASSERT_TRUE(answer.success) << answer.message;
  EXPECT_FALSE(answer.complete);
  EXPECT_EQ(answer.offsets.back(), answer.contacts.size());
  ASSERT_EQ(answer.minimum_lower.size(), 2U);
  EXPECT_EQ(answer.minimum_lower[1], -infinity);

  // Nor is there time to look for what is near the first one, once that is read.
  request.shapes.pop_back();
  EXPECT_FALSE(query(request).complete);
  request.deadline = 0.0;
  EXPECT_TRUE(query(request).complete);
}

TEST_F(EnvironmentServicesTest, ADeadlineIsThatOfAllCandidates) {
  const ros::Publisher publisher = advertise<FiberArray>("fibers");
  connect(publisher, fiber(0.4, -1, 1));
  apply({ball("ball", 0.0, 0.25)});
  CheckFibers::Request request;
  request.type = CheckFibers::Request::ALL;
  for (int i = 0; i < 2000; ++i) {
    request.candidates.push_back(fiber(0.001 * i, -1, 1));
  }
  const auto truth = call<CheckFibers>("check_fibers", request);
  ASSERT_TRUE(truth.success) << truth.message;
  EXPECT_EQ(std::count(truth.complete.begin(), truth.complete.end(), 1), 2000);
  for (const double deadline : {1e-9, 1e-4, 1e-3}) {
    request.deadline = deadline;
    const auto answer = call<CheckFibers>("check_fibers", request);
    ASSERT_TRUE(answer.success) << answer.message;
    ASSERT_EQ(answer.free.size(), 2000U);
    ASSERT_EQ(answer.complete.size(), 2000U);
    ASSERT_EQ(answer.offsets.size(), 2001U);
    EXPECT_EQ(answer.offsets.back(), answer.contacts.size());
    for (std::size_t i = 0; i < 2000; ++i) {
      EXPECT_TRUE(!answer.free[i] || (truth.free[i] && answer.complete[i])) << i;
      EXPECT_TRUE(!answer.complete[i] || answer.free[i] == truth.free[i]) << i;
      const bool has_contact = answer.offsets[i + 1] > answer.offsets[i];
      EXPECT_EQ(answer.decided[i] != 0, answer.free[i] != 0 || has_contact) << i;
    }
    if (deadline == 1e-9) {
      EXPECT_EQ(std::count(answer.complete.begin(), answer.complete.end(), 0), 2000);
    }
  }
}

/// Along y at x, two metres long.
FiberArray fiber_of(std::size_t points, double x) {
  test_messages::Points along_y;
  for (std::size_t i = 0; i < points; ++i) {
    along_y.emplace_back(x, 2.0 * static_cast<double>(i) / static_cast<double>(points - 1), 0.0);
  }
  FiberArray fiber = test_messages::fiber_array(header("world"), along_y);
  fiber.radii = {0.001};
  fiber.names = {"fiber"};
  return fiber;
}

// Blocks are checked one after another. FIRST looks for contacts until the time is up; other types
// keep some of it to write them down, and may end while there is time for the next block.
TEST_F(EnvironmentServicesTest, AfterTheDeadlineNoBlockOfCandidatesIsChecked) {
  constexpr std::size_t count = 2000;
  constexpr std::size_t block = 256;
  const ros::Publisher publisher = advertise<FiberArray>("fibers");
  connect(publisher, fiber(0.4, -1, 1));
  apply({ball("ball", 0.0, 0.25)});
  CheckFibers::Request request;
  request.type = CheckFibers::Request::FIRST;
  for (std::size_t i = 0; i < count; ++i) {
    request.candidates.push_back(fiber_of(400, 1.0 + 0.001 * static_cast<double>(i)));
  }
  std::size_t complete = 0;
  for (double deadline = 0.25e-3; complete < count && deadline < node_test::patience;
       deadline *= 2.0) {
    SCOPED_TRACE(deadline);
    request.deadline = deadline;
    const auto answer = call<CheckFibers>("check_fibers", request);
    ASSERT_TRUE(answer.success) << answer.message;
    ASSERT_EQ(answer.complete.size(), count);
    EXPECT_EQ(answer.free, answer.complete) << "what was not looked at is not free";
    EXPECT_EQ(answer.decided, answer.complete);
    complete =
        static_cast<std::size_t>(std::count(answer.complete.begin(), answer.complete.end(), 1));
    const auto first = std::find(answer.complete.begin(), answer.complete.end(), 0);
    const auto blocks = static_cast<std::size_t>(first - answer.complete.begin()) / block;
    const std::size_t next = std::min((blocks + 1) * block, count);
    EXPECT_EQ(std::count(answer.complete.begin() + next, answer.complete.end(), 1), 0)
        << "candidate " << first - answer.complete.begin() << " is not complete";
  }
  EXPECT_EQ(complete, count);
}

TEST_F(EnvironmentServicesTest, CandidatesTheDeadlineComesBeforeAreNotRead) {
  CheckFibers::Request request;
  request.ignore_self = true;
  request.ignore_fibers = true;
  request.ignore_environment = true;
  // No machine reads a million points in a millisecond. Those after it cannot be read: one of the
  // same block, and one of another.
  request.candidates = {fiber_of(1'000'000, 1.0), fiber_of(2, 1.0), fiber_of(2, 1.0)};
  request.candidates[1].radii.clear();
  request.candidates[2].radii.clear();
  request.candidates[2].names = {"other"};
  const auto refusal = call<CheckFibers>("check_fibers", request);
  EXPECT_FALSE(refusal.success);
  EXPECT_NE(refusal.message.find("candidate 1: has no radii"), std::string::npos)
      << refusal.message;

  request.deadline = 1e-3;
  const auto answer = call<CheckFibers>("check_fibers", request);
  ASSERT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(answer.complete, (std::vector<std::uint8_t>{0, 0, 0}));
  EXPECT_EQ(answer.free, (std::vector<std::uint8_t>{0, 0, 0})) << "nothing is known of them";
  EXPECT_EQ(answer.decided, (std::vector<std::uint8_t>{0, 0, 0}));
  ASSERT_EQ(answer.unknown.size(), 1U);
  EXPECT_EQ(answer.unknown[0].rfind("pairs of candidates: not all have been looked at, as the "
                                    "deadline of 0.001 s",
                                    0),
            0U)
      << answer.unknown[0];
}

}  // namespace
