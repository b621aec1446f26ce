// The running node with ~prediction beside a robot and obstacles that move: as in moving.test.
#include <dynamic_reconfigure/Reconfigure.h>
#include <tf2_ros/transform_broadcaster.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "fiber_proximity/ApplyObstacles.h"
#include "fiber_proximity/TimeToContact.h"
#include "test/ros/messages.hpp"
#include "test/ros/simulated_time_test.hpp"

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using fiber_proximity::FiberArray;
using fiber_proximity::Obstacle;
using fiber_proximity::PredictedContact;
using fiber_proximity::TimeToContact;

constexpr double fiber_radius = 0.01;  // [m] as in moving.test
constexpr double node_margin = 0.02;   // [m] the same
constexpr double horizon = 0.5;        // [s]
constexpr double period = 0.05;        // [s] between messages
constexpr std::size_t frame_count = 4;

/// Where something is after some time [s].
using Way = std::function<Isometry3d(double)>;

Isometry3d at(const Vector3d& position, double angle = 0.0) {
  return Eigen::Translation3d(position) * Eigen::AngleAxisd(angle, Vector3d::UnitZ());
}

class MovingTest : public node_test::SimulatedTimeTest {
 protected:
  void SetUp() override {
    cable_publisher_ = advertise<FiberArray>("/cable");
    tool_ = [](double) { return at({0, 5, 0}); };
    arm_ = [](double) { return at({0, 7, 0}); };
    hang_cable({0, 0, 0});
    pass(20.0);  // tf forgets where links were in the test before
    begin_ = now();
  }

  void hang_cable(const Vector3d& middle) {
    cable_ = [middle](double) { return middle; };
  }

  /// Sends where the links are some time ahead, so that tf knows it when it is asked.
  void send_links() {
    constexpr double ahead = 0.5;  // [s]
    if (!do_links_move_) {
      return;
    }
    for (; sent_ < time() + ahead; sent_ += period) {
      for (const auto& [name, way] :
           {std::make_pair("tool", &tool_), std::make_pair("arm", &arm_)}) {
        transforms_.sendTransform(test_messages::transform(
            test_messages::header("world", begin_ + ros::Duration(sent_)), name, (*way)(sent_)));
      }
    }
  }

  /// [s] since the beginning.
  double time() const { return (now() - begin_).toSec(); }

  /// Sends the cable as it is now.
  const TimeToContact* answer() {
    send_links();
    const Vector3d middle = cable_(time());
    FiberArray message = test_messages::fiber_array(
        test_messages::header("world", now()),
        {middle - Vector3d(0, 0, 0.5), middle, middle + Vector3d(0, 0, 0.5)});
    message.names = {name_};
    cable_publisher_.publish(message);
    const TimeToContact* const told = times_.wait_for(now());
    EXPECT_NE(told, nullptr);
    pass(period);
    return told;
  }

  /// Until tf and the velocities are known.
  const TimeToContact* settled() {
    const TimeToContact* told = nullptr;
    EXPECT_TRUE(node_test::wait_for([&] {
      told = answer();
      return told == nullptr || told->complete != 0;
    }));
    for (std::size_t i = 0; i < frame_count && told != nullptr; ++i) {
      told = answer();
    }
    return told;
  }

  static bool names(const TimeToContact& told, const std::string& text) {
    return told.assumption.find(text) != std::string::npos;
  }

  /// A contact that comes after this time, within 0.1 ms.
  static void expect_in(double seconds, const PredictedContact& told) {
    ASSERT_TRUE(told.expected) << seconds;
    EXPECT_TRUE(told.certain);
    EXPECT_LE(told.time_lower, seconds + 1e-9);
    EXPECT_GE(told.time_upper, seconds - 1e-6);
    EXPECT_LT(told.time_upper - told.time_lower, 1e-4);
  }

  /// Expected as soon as it is within the horizon, with the right time, until it is there.
  /// @param contact [s] after the beginning
  void expect_until(double contact) {
    const TimeToContact* told = settled();
    ASSERT_LT(time() - period, contact - horizon) << "it begins too late";
    int before = 0;
    int expected = 0;
    for (; time() < contact; told = answer()) {
      ASSERT_NE(told, nullptr);
      const double left = contact - (told->header.stamp - begin_).toSec();
      EXPECT_TRUE(told->environment.complete);
      EXPECT_EQ(told->environment.touching, 0U);
      if (left > horizon + 1e-6) {
        EXPECT_FALSE(told->environment.expected) << left;
        EXPECT_EQ(told->environment.time_lower, horizon);
        ++before;
      } else if (left < horizon - 1e-6) {
        expect_in(left, told->environment);
        ++expected;
      }
    }
    EXPECT_GT(before, 1);
    EXPECT_GE(expected, 8);
    pass(period);
    told = answer();
    ASSERT_NE(told, nullptr);
    EXPECT_TRUE(told->environment.touching > 0 || told->environment.expected);
  }

  static void apply(Obstacle obstacle, std::int8_t operation) {
    obstacle.operation = operation;
    obstacle.header.stamp = now();
    if (operation != Obstacle::ADD) {
      obstacle.primitives.clear();
      obstacle.primitive_poses.clear();
    }
    fiber_proximity::ApplyObstacles service;
    service.request.obstacles = {obstacle};
    ASSERT_TRUE(node_test::call_service("/proximity/apply_obstacles", service));
    EXPECT_TRUE(service.response.success) << service.response.message;
  }

  static void set_horizon(double seconds) {
    dynamic_reconfigure::Reconfigure request;
    dynamic_reconfigure::DoubleParameter parameter;
    parameter.name = "prediction";
    parameter.value = seconds;
    request.request.config.doubles.push_back(parameter);
    ASSERT_TRUE(node_test::call_service("/proximity/set_parameters", request));
  }

  ros::Time begin_;
  double sent_ = 0.0;  // [s] up to which the links were sent
  bool do_links_move_ = true;
  std::string name_ = "cable";
  Way tool_;
  Way arm_;
  std::function<Vector3d(double)> cable_;
  tf2_ros::TransformBroadcaster& transforms_ =
      node_test::broadcaster<tf2_ros::TransformBroadcaster>();
  ros::Publisher cable_publisher_;
  node_test::Recorder<TimeToContact> times_{node, "/proximity/time_to_contact"};
};

TEST_F(MovingTest, ALinkThatComesIsExpectedBeforeItTouches) {
  hang_cable({0.5, 0, 0});
  tool_ = [](double time) { return at({0.2 * time, 0, 0}); };
  expect_until((0.5 - fiber_radius - node_margin - 0.03) / 0.2);
  const TimeToContact& told = *times_.messages.back();
  EXPECT_TRUE(names(told, "at least 4 over 0.2 s (robot/arm, robot/tool)")) << told.assumption;
  EXPECT_TRUE(names(told, "stand still (shelf)")) << told.assumption;
  EXPECT_EQ(told.frames, frame_count);
}

TEST_F(MovingTest, AnArmThatTurnsIsExpectedBeforeItTouches) {
  constexpr double rate = 0.8;  // [rad/s]
  hang_cable({0.0, 0.5, 0});
  arm_ = [](double time) { return at({0, 0, 0}, rate * time); };
  // Where the arm's side is so far from the cable's axis.
  const double half_width = std::asin((0.02 + fiber_radius + node_margin) / 0.5);
  expect_until((std::acos(0.0) - half_width) / rate);
}

TEST_F(MovingTest, ACableThatFollowsALinkMeetsItWhereThatStops) {
  constexpr double speed = 0.2;  // [m/s]
  constexpr double gap = 0.08;   // [m] beyond the margin
  constexpr double stop = 2.0;   // [s]
  const double ahead = gap + node_margin + fiber_radius + 0.03;
  cable_ = [](double time) { return Vector3d(speed * time, 0, 0); };
  tool_ = [ahead](double time) { return at({speed * (time < stop ? time : stop) + ahead, 0, 0}); };
  settled();
  while (time() < stop - 1e-6) {
    const TimeToContact* const told = answer();
    ASSERT_NE(told, nullptr);
    EXPECT_FALSE(told->environment.expected);
    EXPECT_EQ(told->environment.time_lower, horizon);
  }
  for (std::size_t i = 1; i < frame_count; ++i) {
    answer();
  }
  const TimeToContact* const told = answer();
  ASSERT_NE(told, nullptr);
  expect_in(gap / speed - (told->header.stamp - begin_).toSec() + stop, told->environment);
}

TEST_F(MovingTest, ACableThatWasSentOnceStandsStillWhileLinksMove) {
  hang_cable({0.5, 0, 0});
  tool_ = [](double time) { return at({0.2 * time, 0, 0}); };
  settled();
  while (time() < 1.8) {
    answer();
  }
  name_ = "another";
  const TimeToContact* const told = answer();
  ASSERT_NE(told, nullptr);
  EXPECT_EQ(told->problem, "");
  EXPECT_TRUE(names(*told, "/cable, with one message, stands still")) << told->assumption;
  expect_in(2.2 - (told->header.stamp - begin_).toSec(), told->environment);
}

TEST_F(MovingTest, ALinkThatIsNotHeardOfIsUnknownAndNotStanding) {
  hang_cable({0.5, 0, 0});
  tool_ = [](double time) { return at({0.2 * time, 0, 0}); };
  const TimeToContact* told = settled();
  while (time() < 1.5) {
    told = answer();
  }
  do_links_move_ = false;
  const double last = sent_ - period;  // [s] of what tf has heard
  for (int i = 0; i < 24; ++i) {
    told = answer();
    ASSERT_NE(told, nullptr);
    const double age = (told->header.stamp - begin_).toSec() - last;
    SCOPED_TRACE(age);
    if (age > 0.3 + 1e-6) {
      EXPECT_FALSE(told->environment.complete);
      EXPECT_EQ(told->environment.time_lower, 0.0);
      EXPECT_EQ(told->unknown.size(), 2U);
    } else if (age < 0.3 - 1e-6) {
      EXPECT_TRUE(told->environment.complete);
      // It goes on from where it was heard of last.
      const double from = std::min(last, (told->header.stamp - begin_).toSec());
      if (2.2 - from < horizon - 1e-6) {
        expect_in(2.2 - from, told->environment);
      }
    }
  }
  EXPECT_FALSE(told->environment.complete);
}

TEST_F(MovingTest, AnObstacleThatIsMovedGoesOnAndOneThatIsReplacedStands) {
  const auto ball_at = [](double x) { return test_messages::ball("ball", x, 0.05); };
  apply(ball_at(-2.0), Obstacle::ADD);
  const TimeToContact* told = settled();
  double x = -1.0;
  for (int i = 0; i < 6; ++i, x += 0.05) {  // 1 m/s
    apply(ball_at(x), Obstacle::ADD);
    told = answer();
  }
  ASSERT_NE(told, nullptr);
  EXPECT_FALSE(told->environment.expected) << "each is another one";
  EXPECT_TRUE(names(*told, "stand still (ball, shelf)")) << told->assumption;
  for (int i = 0; i < 6; ++i, x += 0.05) {
    apply(ball_at(x), Obstacle::MOVE);
    told = answer();
  }
  ASSERT_NE(told, nullptr);
  EXPECT_TRUE(names(*told, "(ball, robot/arm, robot/tool)")) << told->assumption;
  expect_in((-0.05 - fiber_radius - node_margin) - (x - 0.05), told->environment);
  // It goes on for robot_timeout, as nothing tells that it stands.
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(answer()->environment.expected);
  }
  answer();
  told = answer();
  EXPECT_FALSE(told->environment.expected);
  EXPECT_TRUE(names(*told, "stand still (ball, shelf)")) << told->assumption;
  apply(ball_at(0.0), Obstacle::REMOVE);
}

TEST_F(MovingTest, WhatTurnsTooFarIsToldToBeUnknown) {
  constexpr double rate = 30.0;  // [rad/s]
  arm_ = [](double time) { return at({0, 7, 0}, rate * time); };
  set_horizon(10.0);
  const TimeToContact* told = nullptr;
  ASSERT_TRUE(node_test::wait_for([&] {
    told = answer();
    return told == nullptr || (told->horizon == 10.0 && told->environment.time_lower > 0.0);
  }));
  for (std::size_t i = 0; i < frame_count; ++i) {
    told = answer();
  }
  ASSERT_NE(told, nullptr);
  EXPECT_FALSE(told->environment.complete);
  EXPECT_FALSE(told->environment.expected);
  EXPECT_NEAR(told->environment.time_lower, 99.0 / rate, 1e-6);
  ASSERT_EQ(told->unknown.size(), 1U);
  EXPECT_NE(told->unknown[0].find("one has turned by 99 rad by then"), std::string::npos)
      << told->unknown[0];
  EXPECT_TRUE(told->different_fibers.complete);
  set_horizon(horizon);
}

}  // namespace
