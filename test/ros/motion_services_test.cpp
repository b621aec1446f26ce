// The running node without a fixed frame: motions of candidates that ~check_fibers checks.
#include <cmath>
#include <string>

#include "fiber_proximity/ApplyObstacles.h"
#include "fiber_proximity/CheckFibers.h"
#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"
#include "test/support/not_finite.hpp"

namespace {

using fiber_proximity::ApplyObstacles;
using fiber_proximity::CheckFibers;
using fiber_proximity::Contact;
using fiber_proximity::FiberArray;
using fiber_proximity::Obstacle;
using test_messages::header;

using fiber::test::infinity;
constexpr double radius = 0.001;

/// A straight cable along x or y, 0.2 m long about the z axis, at a height.
FiberArray cable(double z, bool along_x, std::size_t points = 5,
                 const std::string& name = "cable") {
  test_messages::Points line;
  for (std::size_t i = 0; i < points; ++i) {
    const double at = -0.1 + 0.2 * static_cast<double>(i) / static_cast<double>(points - 1);
    line.emplace_back(along_x ? at : 0.01, along_x ? 0.01 : at, z);
  }
  FiberArray cable = test_messages::fiber_array(header("world"), line);
  cable.radii = {radius};
  cable.names = {name};
  return cable;
}

class MotionServices : public node_test::NodeTest {
 protected:
  static CheckFibers::Response check(const CheckFibers::Request& request) {
    CheckFibers check;
    check.request = request;
    EXPECT_TRUE(node_test::call_service("/proximity/check_fibers", check));
    return check.response;
  }

  static std::string error_of(const CheckFibers::Request& request) {
    const CheckFibers::Response answer = check(request);
    EXPECT_FALSE(answer.success);
    EXPECT_TRUE(answer.free.empty() && answer.contacts.empty() && answer.offsets.empty())
        << "half answered";
    return answer.message;
  }

  /// A plate of a tenth of a millimetre at z = 1, in steps of the cable along x; and a cable at 2.
  void set_up() {
    publisher_ = advertise<FiberArray>("fibers");
    connect(publisher_, cable(2.0, false));
    ApplyObstacles apply;
    apply.request.obstacles.emplace_back();  // whatever other tests have left there goes
    apply.request.obstacles.back().operation = Obstacle::REMOVE;
    apply.request.obstacles.emplace_back();
    Obstacle& plate = apply.request.obstacles.back();
    plate.header.frame_id = "world";
    plate.id = "plate";
    plate.operation = Obstacle::ADD;
    plate.pose.orientation.w = 1.0;
    plate.primitives.resize(1);
    plate.primitives[0].type = shape_msgs::SolidPrimitive::BOX;
    plate.primitives[0].dimensions = {1.0, 1.0, 1e-4};
    plate.primitive_poses.resize(1);
    plate.primitive_poses[0].position.z = 1.0;
    plate.primitive_poses[0].orientation.w = 1.0;
    ASSERT_TRUE(node_test::call_service("/proximity/apply_obstacles", apply));
    ASSERT_TRUE(apply.response.success) << apply.response.message;
  }

  ros::Publisher publisher_;
};

/// Motions: up from 0 to below the plate; through the plate; from above the plate through the
/// cable at 2, at once and with a stop; up from above the cable.
CheckFibers::Request motions() {
  CheckFibers::Request request;
  request.type = CheckFibers::Request::ALL;
  for (const double z : {0.0, 0.9, 0.5, 1.5, 1.5, 2.5, 1.2, 1.6, 2.4, 2.6, 3.0}) {
    request.candidates.push_back(cable(z, true));
  }
  request.waypoint_offsets = {0, 2, 4, 6, 9, 11};
  return request;
}

TEST_F(MotionServices, WhatIsBetweenTwoStatesIsFound) {
  set_up();
  CheckFibers::Request request = motions();
  request.waypoint_offsets.clear();
  CheckFibers::Response answer = check(request);
  ASSERT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(answer.free, std::vector<std::uint8_t>(11, 1)) << "each state is free";
  EXPECT_TRUE(answer.time_lower.empty() && answer.time_upper.empty());

  request = motions();
  answer = check(request);
  ASSERT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(answer.free, (std::vector<std::uint8_t>{1, 0, 0, 0, 1}));
  EXPECT_EQ(answer.complete, (std::vector<std::uint8_t>(5, 1)));
  EXPECT_EQ(answer.object_names, std::vector<std::string>{"plate"});
  ASSERT_EQ(answer.offsets.size(), 6U);
  EXPECT_EQ(answer.offsets[1], 0U);
  EXPECT_EQ(answer.offsets[2], 4U) << "each segment of the cable";
  EXPECT_EQ(answer.offsets[5], answer.offsets[4]);
  ASSERT_EQ(answer.time_lower.size(), answer.contacts.size());
  ASSERT_EQ(answer.time_upper.size(), answer.contacts.size());
  const double at_plate = (1.0 - 0.5e-4 - radius - 0.5) / 1.0;
  const double at_cable[] = {(2.0 - 2.0 * radius - 1.5) / 1.0,
                             1.0 + (2.0 - 2.0 * radius - 1.6) / 0.8};
  for (std::size_t i = 0; i < answer.contacts.size(); ++i) {
    const bool is_plate = i < 4;
    EXPECT_EQ(answer.contacts[i].type_a, Contact::CANDIDATE);
    EXPECT_EQ(answer.contacts[i].type_b, is_plate ? Contact::OBJECT : Contact::FIBER);
    const double time = is_plate ? at_plate : at_cable[i < answer.offsets[3] ? 0 : 1];
    EXPECT_LE(answer.time_lower[i], time);
    EXPECT_GE(answer.time_upper[i], time);
    EXPECT_LE(answer.time_upper[i] - answer.time_lower[i], 1e-5);
    EXPECT_NEAR(answer.contacts[i].distance, 0.0, 1e-5);
    EXPECT_NEAR(std::abs(answer.contacts[i].normal.z), 1.0, 1e-3);
    EXPECT_NEAR(answer.contacts[i].point_a.z, is_plate ? 1.0 - 0.5e-4 : 2.0 - radius, 1e-5);
  }
  EXPECT_GT(answer.offsets[3], answer.offsets[2]);
  EXPECT_GT(answer.offsets[4], answer.offsets[3]);

  request.type = CheckFibers::Request::FIRST;
  request.motion_tolerance = 1e-9;
  answer = check(request);
  ASSERT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(answer.free, (std::vector<std::uint8_t>{1, 0, 0, 0, 1}));
  EXPECT_EQ(answer.offsets, (std::vector<std::uint32_t>{0, 0, 1, 2, 3, 3}));
  EXPECT_NEAR(answer.time_lower[2], at_cable[1], 1e-8);

  request.ignore_environment = 1;
  request.replaced_fibers = {"cable"};
  EXPECT_EQ(check(request).free, std::vector<std::uint8_t>(5, 1));
}

TEST_F(MotionServices, ContactsAtTheFirstStateCount) {
  set_up();
  CheckFibers::Request request;
  request.type = CheckFibers::Request::FIRST;
  request.candidates = {cable(1.0, true), cable(1.5, true)};
  request.waypoint_offsets = {0, 2};
  const CheckFibers::Response answer = check(request);
  ASSERT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(answer.free, std::vector<std::uint8_t>{0});
  EXPECT_EQ(answer.time_lower, std::vector<double>{0.0});
  EXPECT_EQ(answer.time_upper, std::vector<double>{0.0});
  EXPECT_LT(answer.contacts[0].distance, -radius);
}

TEST_F(MotionServices, WhatIsNoMotionIsRefused) {
  set_up();
  const auto expect_error = [](const CheckFibers::Request& request, const std::string& part) {
    const std::string message = error_of(request);
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  CheckFibers::Request request = motions();
  request.candidates[5] = cable(2.5, true, 7);
  expect_error(request,
               "motion 2, state 1 (candidate 5): the fibres change their topology: 1 of 5 points "
               "before, 1 of 7 after");
  request.candidates[5] = cable(2.5, true, 5, "other");
  expect_error(request, "motion 2, state 1 (candidate 5): has other names");
  request.candidates[5] = cable(2.5, true);
  request.candidates[5].points[1].x = std::nan("");
  expect_error(request, "motion 2, state 1 (candidate 5): ");

  request = motions();
  request.waypoint_offsets = {1, 11};
  expect_error(request, "waypoint_offsets begins with 1, it must begin with 0");
  request.waypoint_offsets = {0, 10};
  expect_error(request,
               "waypoint_offsets ends with 10, it must end with the number of candidates, 11");
  request.waypoint_offsets = {0, 2, 3, 11};
  expect_error(request, "waypoint_offsets has 3 behind 2: motion 1 needs at least 2 states");
  request.waypoint_offsets = {0, 4, 2, 11};
  expect_error(request, "waypoint_offsets has 2 behind 4: motion 1 needs at least 2 states");
  request.waypoint_offsets = {0};
  expect_error(request, "waypoint_offsets ends with 0");

  for (const double tolerance : {-1e-6, infinity, std::nan("")}) {
    request = motions();
    request.motion_tolerance = tolerance;
    expect_error(request, "motion_tolerance is ");
  }
  for (const auto type : {CheckFibers::Request::CLOSEST, CheckFibers::Request::FIBER_PAIRS}) {
    request = motions();
    request.type = type;
    expect_error(request, "of motions it must be 0 (FIRST), 2 (LIMITED) or 3 (ALL)");
  }
  request = motions();
  request.margin = -1.0;
  expect_error(request, "margin is -1");
}

TEST_F(MotionServices, ADeadlineIsThatOfAllMotions) {
  set_up();
  CheckFibers::Request request;
  request.type = CheckFibers::Request::ALL;
  request.waypoint_offsets = {0};
  for (std::uint32_t i = 0; i < 1000; ++i) {
    request.candidates.push_back(cable(0.5 + 1e-4 * i, true));
    request.candidates.push_back(cable(1.5, true));
    request.waypoint_offsets.push_back(2 * (i + 1));
  }
  CheckFibers::Response answer = check(request);
  ASSERT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(answer.free, std::vector<std::uint8_t>(1000, 0));
  EXPECT_EQ(answer.complete, std::vector<std::uint8_t>(1000, 1));
  EXPECT_EQ(answer.offsets.back(), 4000U);
  request.deadline = 1e-9;
  answer = check(request);
  ASSERT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(answer.free, std::vector<std::uint8_t>(1000, 0)) << "nothing is known of them";
  EXPECT_EQ(answer.decided, std::vector<std::uint8_t>(1000, 0));
  EXPECT_EQ(answer.complete, std::vector<std::uint8_t>(1000, 0));
  EXPECT_EQ(answer.offsets, std::vector<std::uint32_t>(1001, 0));
}

}  // namespace
