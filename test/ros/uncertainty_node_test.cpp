// The running node with an input whose points are known to 10 mm, and an exact one: all answers
// have room for it. The margin is 20 mm.
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "fiber_proximity/CheckFibers.h"
#include "fiber_proximity/TimeToContact.h"
#include "test/ros/live_settings.hpp"
#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

namespace {

using fiber_proximity::CheckFibers;
using fiber_proximity::Contact;
using fiber_proximity::ContactArray;
using fiber_proximity::FiberArray;
using fiber_proximity::QueryProximity;
using node_test::call_service;
using test_messages::fiber_array;
using test_messages::header;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double radius = 0.01;       // [m]
constexpr double uncertainty = 0.01;  // [m] of tracked fibres
constexpr double tiny = 1e-12;        // [m]

class UncertaintyNodeTest : public node_test::NodeTest {
 protected:
  /// Cables along x with their axes at these y and z.
  static FiberArray cables(const std::vector<std::array<double, 2>>& places) {
    FiberArray message = fiber_array(header("world"), {});
    message.offsets = {0};
    for (const auto& [y, z] : places) {
      for (const double x : {-0.5, 0.5}) {
        message.points.push_back(fiber_proximity_ros::to_message(Eigen::Vector3d(x, y, z)));
      }
      message.offsets.push_back(static_cast<std::uint32_t>(message.points.size()));
    }
    message.radii = {radius};
    return message;
  }

  /// @returns the answer about these and the known fibres before
  const ContactArray* answer_to(FiberArray message) {
    stamp_ = message.header.stamp = new_stamp();
    tracked_.publish(message);
    return contacts.wait_for(stamp_);
  }

  /// Two known cables at a gap of 25 mm, tracked ones above with gaps of 25 mm and of 5 mm to the
  /// known ones, and one 15 mm above the ball.
  void SetUp() override {
    FiberArray message = cables({{0.0, 0.0}, {0.0, 0.025 + 2 * radius}, {1.0, 0.0}});
    ASSERT_TRUE(known_around_.wait_for_connection());
    ASSERT_TRUE(node_test::wait_for([&] {
      message.header.stamp = new_stamp();
      known_.publish(message);
      answer_ = answer_to(first());
      return answer_ != nullptr && answer_->fiber_names.size() == 6;
    }));
  }

  static FiberArray first() {
    return cables({{0.025 + 2 * radius, 0.0}, {1.0, 0.005 + 2 * radius}, {0.0, -0.875}});
  }

  /// What the node predicts with this margin of a tracked cable at y = 0.4 that goes on at 0.5 m/s
  /// towards the known ones.
  const fiber_proximity::TimeToContact* told_of_an_approach(double margin) {
    const fiber_proximity::TimeToContact* told = nullptr;
    EXPECT_TRUE(node_test::wait_for([&] {
      answer_to(cables({{0.45, 0.0}}));
      FiberArray next = cables({{0.4, 0.0}});
      next.header.stamp = stamp_ + ros::Duration(0.1);
      tracked_.publish(next);
      told = times_.wait_for(next.header.stamp);
      return told != nullptr && told->problem.empty() && told->frames == 2 &&
             told->margin == margin;
    }));
    return told;
  }

  /// The fibres of the tracked input come first.
  static const Contact* find(const std::vector<Contact>& contacts, std::uint32_t a,
                             std::uint32_t b) {
    for (const Contact& contact : contacts) {
      if (contact.fiber_a == a && contact.fiber_b == b) {
        return &contact;
      }
    }
    return nullptr;
  }

  static void expect_bounds(const Contact& contact, double told, double by, bool certain) {
    EXPECT_NEAR(contact.distance, told, tiny);
    EXPECT_NEAR(contact.lower, told - by, tiny);
    EXPECT_NEAR(contact.upper, told + by, tiny);
    EXPECT_EQ(contact.certain != 0, certain);
  }

  ros::Publisher tracked_ = advertise<FiberArray>("tracked");
  ros::Publisher known_ = advertise<FiberArray>("known");
  node_test::Recorder<ContactArray> known_around_{node, "/proximity/environment_contacts"};
  node_test::Recorder<fiber_proximity::TimeToContact> times_{node, "/proximity/time_to_contact"};
  ros::Time stamp_;
  const ContactArray* answer_ = nullptr;
};

TEST_F(UncertaintyNodeTest, ContactsArePossibleOrCertain) {
  ASSERT_EQ(answer_->contacts.size(), 2U) << "the known fibres 25 mm apart are no contact";
  const Contact* const possible = find(answer_->contacts, 0, 3);
  const Contact* const certain = find(answer_->contacts, 1, 5);
  ASSERT_NE(possible, nullptr);
  ASSERT_NE(certain, nullptr);
  expect_bounds(*possible, 0.025, uncertainty, false);
  expect_bounds(*certain, 0.005, uncertainty, true);
  EXPECT_EQ(answer_->minimum_distance, certain->distance);
  EXPECT_NEAR(answer_->minimum_lower, -0.005, tiny);
  EXPECT_NEAR(answer_->minimum_upper, 0.015, tiny);
  EXPECT_TRUE(answer_->complete);
  const fiber_proximity::Statistics* const told = statistics.wait_for(stamp_);
  ASSERT_NE(told, nullptr);
  EXPECT_NEAR(told->contact_error, uncertainty, tiny);
  EXPECT_NEAR(told->minimum_lower, -0.005, tiny);
  EXPECT_NE(told->summary.find("2 possible contacts, 1 of them certain"), std::string::npos)
      << told->summary;
  const ContactArray* const around = known_around_.wait_for(stamp_);
  ASSERT_NE(around, nullptr);
  ASSERT_EQ(around->contacts.size(), 1U);
  expect_bounds(around->contacts.front(), 0.015, uncertainty, false);
  EXPECT_NEAR(around->minimum_lower, 0.005, tiny);
}

TEST_F(UncertaintyNodeTest, WhatCameAndWentWasPossibleOrCertain) {
  // One goes through a known cable, the other passes over one with a gap of 25 mm.
  const double above = 0.025 + 2 * radius;
  ASSERT_NE(answer_to(cables({{0.5, 0.0}, {1.5, above}})), nullptr);
  const ContactArray* const told = answer_to(cables({{-0.5, 0.0}, {0.5, above}}));
  ASSERT_NE(told, nullptr);
  ASSERT_TRUE(told->continuous);
  const Contact* const certain = find(told->contacts, 0, 2);
  const Contact* const possible = find(told->contacts, 1, 4);
  ASSERT_NE(certain, nullptr);
  ASSERT_NE(possible, nullptr);
  EXPECT_TRUE(certain->gone);
  EXPECT_TRUE(certain->certain);
  EXPECT_TRUE(possible->gone);
  EXPECT_FALSE(possible->certain);
  const auto part = [told](const ros::Time& time) {
    return (time - told->since).toSec() / (told->header.stamp - told->since).toSec();
  };
  // The told gap is 30 mm, which leaves room for the margin, at y = 50 mm, and 10 mm at y = 30 mm.
  constexpr double rounding = 1e-5;  // of whole nanoseconds
  EXPECT_NEAR(part(certain->time_lower), 0.45, rounding);
  EXPECT_NEAR(part(certain->time_upper), 0.47, rounding);
  EXPECT_NEAR(certain->distance, 0.01, 1e-5) << "at time_upper, by the tolerance";
  EXPECT_NEAR(certain->upper, certain->distance + uncertainty, tiny);
  const double first = std::sqrt(0.05 * 0.05 - above * above);
  EXPECT_NEAR(part(possible->time_lower), 0.5 - first, rounding);
  EXPECT_NEAR(part(possible->time_upper), 0.5 + first, rounding) << "when it was possible last";
}

TEST_F(UncertaintyNodeTest, ShapesAndCandidatesAreAnsweredForAllTrueFibers) {
  QueryProximity query;
  query.request.type = QueryProximity::Request::ALL;
  query.request.margin = 0.02;
  query.request.shapes.resize(1);
  query.request.shapes[0].radius = radius;
  query.request.shapes[0].points = {
      fiber_proximity_ros::to_message(Eigen::Vector3d(0.0, 2 * 0.025 + 4 * radius, 0.0))};
  ASSERT_TRUE(call_service("/proximity/query", query));
  ASSERT_EQ(query.response.contacts.size(), 1U) << query.response.message;
  expect_bounds(query.response.contacts[0], 0.025, uncertainty, false);
  EXPECT_NEAR(query.response.minimum_lower[0], 0.015, tiny);

  const auto candidate = [](double y, double z) {
    FiberArray message = cables({{y, z}});
    message.header = header("world");
    return message;
  };
  CheckFibers check;
  check.request.type = CheckFibers::Request::ALL;
  check.request.margin = 0.02;
  check.request.candidates = {
      candidate(2 * 0.025 + 4 * radius, 0.0),  // 25 mm beside a tracked one
      candidate(-0.025 - 2 * radius, 0.0),     // 25 mm beside a known one
      candidate(1.0, 2 * 0.005 + 4 * radius),  // 5 mm above a tracked one
  };
  ASSERT_TRUE(call_service("/proximity/check_fibers", check));
  ASSERT_EQ(check.response.free.size(), 3U) << check.response.message;
  const std::array<bool, 3> is_free{false, true, false};
  const std::array<bool, 3> is_decided{false, true, true};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(check.response.free[i] != 0, is_free[i]) << i;
    EXPECT_EQ(check.response.decided[i] != 0, is_decided[i]) << i;
  }
  ASSERT_EQ(check.response.contacts.size(), 2U);
  EXPECT_EQ(check.response.contacts[0].fiber_b, 0U);
  expect_bounds(check.response.contacts[0], 0.025, uncertainty, false);
  EXPECT_NEAR(check.response.contacts[0].point_b.y, 0.025 + 3 * radius, tiny);
  expect_bounds(check.response.contacts[1], 0.005, uncertainty, true);

  // Coming down on a tracked cable from 100 mm: possible from a gap of 30 mm on, certain never
  // told.
  check.request.candidates = {candidate(1.0, 0.005 + 4 * radius + 0.1),
                              candidate(1.0, 0.005 + 4 * radius + 0.02)};
  check.request.waypoint_offsets = {0, 2};
  ASSERT_TRUE(call_service("/proximity/check_fibers", check));
  ASSERT_EQ(check.response.contacts.size(), 1U) << check.response.message;
  EXPECT_FALSE(check.response.free[0]);
  EXPECT_FALSE(check.response.decided[0]);
  EXPECT_NEAR(check.response.time_lower[0], 0.07 / 0.08, 1e-3);
  EXPECT_LE(check.response.time_lower[0], 0.07 / 0.08);
  EXPECT_EQ(check.response.time_upper[0], infinity);
}

TEST_F(UncertaintyNodeTest, TimesToContactAreOfPossibleContacts) {
  // Every pair of tracked fibres may be off by 20 mm.
  const fiber_proximity::TimeToContact* const told = told_of_an_approach(0.02);
  ASSERT_NE(told, nullptr);
  const fiber_proximity::PredictedContact& contact = told->different_fibers;
  EXPECT_TRUE(contact.expected);
  EXPECT_FALSE(contact.certain);
  EXPECT_EQ(contact.time_upper, infinity);
  EXPECT_GE(contact.touching, 1U);
  EXPECT_EQ(contact.time_lower, 0.0) << "known fibres 25 mm apart may count as near as 40 mm";
  EXPECT_FALSE(told->environment.certain);
}

TEST_F(UncertaintyNodeTest, AContactIsCertainByTheTimeThatToldPointsAreWellWithinTheMargin) {
  fiber_proximity::ProximityConfig config = fiber_proximity::ProximityConfig::__getDefault__();
  config.margin = 0.05;
  config.prediction = 1.0;
  config.prediction_frames = 2;
  node_test::set_parameters(config);
  // The gap to the known cable at y = 0 is 0.38 m. One of 0.03 m is within the margin wherever two
  // tracked fibres are.
  const fiber_proximity::TimeToContact* const told = told_of_an_approach(0.05);
  ASSERT_NE(told, nullptr);
  EXPECT_TRUE(told->different_fibers.certain);
  EXPECT_NEAR(told->different_fibers.time_upper, (0.38 - 0.03) / 0.5, 1e-4);
  EXPECT_GE(told->different_fibers.time_upper, (0.38 - 0.03) / 0.5 - 1e-6);
}

}  // namespace
