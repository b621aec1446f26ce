#include "src/geometry/rigid_contact_time.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using WideVector = Eigen::Matrix<long double, 3, 1>;

constexpr double pi = 3.141592653589793;

Vector3d place_of(const RigidSegment& segment, int end, double time) {
  return (1.0 - time) * segment.before.position + time * segment.after.position +
         segment.before.rotation.slerp(time, segment.after.rotation) * segment.ends[end];
}

double distance_at(const RigidSegment& a, const RigidSegment& b, double time) {
  return segment_distance(place_of(a, 0, time), place_of(a, 1, time), place_of(b, 0, time),
                          place_of(b, 1, time))
      .distance;
}

/// [m per motion] No point is faster.
double speed_of(const RigidSegment& segment) {
  return (segment.after.position - segment.before.position).norm() +
         segment.before.rotation.angularDistance(segment.after.rotation) *
             std::max(segment.ends[0].norm(), segment.ends[1].norm());
}

/// Whether the distance stays above the limit before a time, but for rounding: by halving pieces
/// until the bodies are too slow to meet in them.
bool stays_apart(const RigidSegment& a, const RigidSegment& b, double limit, double end) {
  const double speed = speed_of(a) + speed_of(b);
  std::vector<std::pair<double, double>> pieces;
  if (end > 0.0) {
    pieces.emplace_back(0.0, end);
  }
  while (!pieces.empty()) {
    const auto [begin, finish] = pieces.back();
    pieces.pop_back();
    const double middle = 0.5 * (begin + finish);
    const double gap = distance_at(a, b, middle) - limit;
    if (gap < -1e-12) {
      return false;
    }
    if (gap <= 0.5 * speed * (finish - begin) && finish - begin > 1e-9) {
      pieces.emplace_back(begin, middle);
      pieces.emplace_back(middle, finish);
    }
  }
  return true;
}

RigidSegment random_segment(Random& random, double most_angle) {
  RigidSegment segment;
  segment.ends[0] = random.in_cube();
  segment.ends[1] = random.in_cube();
  segment.before = {random.rotation(), random.in_cube()};
  const AngleAxisd turn(random.uniform(0.0, most_angle), random.direction());
  segment.after = {turn * segment.before.rotation, random.in_cube()};
  if (random.chance(0.5)) {
    segment.after.rotation.coeffs() *= -1.0;  // the same rotation
  }
  return segment;
}

TEST(RigidContactTime, NoContactIsMissedAndNoneIsInvented) {
  SCOPED_TRACE(seed_message());
  Random random;
  int hits = 0;
  int certain = 0;
  for (int round = 0; round < rounds(1000); ++round) {
    const RigidSegment a = random_segment(random, 0.99 * pi);
    const RigidSegment b = random_segment(random, random.chance(0.5) ? 0.0 : 1.0);
    const ContactLimit limit{random.uniform(0.0, 0.1), random.uniform(0.0, 0.1), 0.0};
    const double sum = limit.radius_a + limit.radius_b;
    const double tolerance = random.chance(0.5) ? 1e-3 : 1e-6;
    const ContactTime time = contact_time(a, b, limit, tolerance);
    ASSERT_TRUE(stays_apart(a, b, sum, time.lower)) << round;
    if (time.hit) {
      ASSERT_TRUE(std::isfinite(time.upper)) << round;
      ASSERT_LE(time.lower, time.upper);
      ASSERT_LE(distance_at(a, b, time.upper), sum + tolerance + 1e-12) << round;
      ASSERT_TRUE(!time.certain || distance_at(a, b, time.upper) <= sum + 1e-12) << round;
      ++hits;
      certain += time.certain ? 1 : 0;
    }
  }
  expect_enough(hits, rounds(120));
  expect_enough(certain, rounds(110));
}

/// A rod along x that turns about the origin by this angle about z.
RigidSegment turning_rod(double angle) {
  RigidSegment rod;
  rod.ends[0] = {0.2, 0.0, 0.0};
  rod.ends[1] = {1.0, 0.0, 0.0};
  rod.after.rotation = AngleAxisd(angle, Vector3d::UnitZ());
  return rod;
}

RigidSegment still_post(double x, double y) {
  RigidSegment post;
  post.ends[0] = {x, y, -1.0};
  post.ends[1] = {x, y, 1.0};
  return post;
}

TEST(RigidContactTime, ARodThatTurnsMeetsAPostWhenItPointsThere) {
  const double half = std::sqrt(0.5);
  const ContactTime time = contact_time(turning_rod(0.5 * pi), still_post(0.7 * half, 0.7 * half),
                                        {0.01, 0.02, 0.0}, 1e-9);
  // The post is 0.7 m from the axis: the rod is nearer than 0.03 m from that angle before 45°.
  const double truth = 0.5 - std::asin(0.03 / 0.7) / (0.5 * pi);
  EXPECT_TRUE(time.hit && time.certain);
  EXPECT_LE(time.lower, truth);
  EXPECT_GE(time.upper, truth);
  EXPECT_LE(time.upper - time.lower, 1e-7);
}

TEST(RigidContactTime, AnArcIsNotItsChord) {
  // The ends of half a turn are on the line through the axis: straight motion would pass it by.
  EXPECT_TRUE(
      contact_time(turning_rod(0.999 * pi), still_post(0.0, 0.6), {0.01, 0.01, 0.0}, 1e-6).hit);
  // And the chord of a quarter turn comes nearer to the axis than the arc does.
  RigidSegment tip = turning_rod(0.5 * pi);
  tip.ends[0] = tip.ends[1];
  EXPECT_FALSE(contact_time(tip, still_post(0.5, 0.5), {0.01, 0.01, 0.0}, 1e-6).hit);
}

TEST(RigidContactTime, TurnsTheShorterWayRound) {
  EXPECT_TRUE(
      contact_time(turning_rod(1.5 * pi), still_post(0.3, -0.3), {0.01, 0.01, 0.0}, 1e-6).hit);
  EXPECT_FALSE(
      contact_time(turning_rod(1.5 * pi), still_post(0.3, 0.3), {0.01, 0.01, 0.0}, 1e-6).hit);
}

/// Bodies far away whose ends go through no doubles: a rod that passes a ball and touches it by
/// less than a rounding.
TEST(RigidContactTime, WhatOnlyJustTouchesFarAwayIsFound) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < rounds(1000); ++round) {
    // Half a turn about an axis of small numbers, so that what is turned is known exactly.
    const Vector3d axis(random.integer(-3, 3), random.integer(-3, 3), 4.0);
    const Vector3d place = 1e8 * random.direction();
    const Vector3d way = random.in_cube();
    RigidSegment rod;
    rod.ends[0] = random.in_cube();
    rod.ends[1] = random.in_cube();
    rod.before.rotation = rod.after.rotation = Quaterniond(0.0, axis.x(), axis.y(), axis.z());
    rod.before.rotation.normalize();
    rod.after.rotation.normalize();
    rod.before.position = place;
    rod.after.position = place + way;
    const auto turned = [&](const Vector3d& x) -> WideVector {
      const auto a = axis.cast<long double>();
      const auto wide = x.cast<long double>();
      return 2.0L * a.dot(wide) / a.dot(a) * a - wide;
    };
    RigidSegment ball;  // above the middle of what the rod sweeps
    const Vector3d along = (turned(rod.ends[1]) - turned(rod.ends[0])).cast<double>();
    const Vector3d up = along.cross(way).normalized();
    const Vector3d middle =
        (0.5L * (turned(rod.ends[0]) + turned(rod.ends[1]))).cast<double>() + 0.5 * way;
    ball.before.position = ball.after.position = place + middle + random.uniform(0.1, 1.0) * up;
    ball.ends[0] = ball.ends[1] = Vector3d::Zero();
    // Relative to the place, where doubles are exact.
    const Vector3d real_way = rod.after.position - rod.before.position;
    const WideVector offset =
        (ball.before.position - rod.before.position).cast<long double>() - turned(rod.ends[0]);
    const WideVector normal =
        (turned(rod.ends[1]) - turned(rod.ends[0])).cross(real_way.cast<long double>());
    const long double distance = std::abs(offset.dot(normal)) / normal.norm();
    const double reach =
        std::nextafter(static_cast<double>(distance), 2.0 * static_cast<double>(distance));
    const ContactTime time = contact_time(rod, ball, {reach, 0.0, 0.0}, 1e-12);
    ASSERT_TRUE(time.hit) << round;
  }
}

TEST(RigidContactTime, RefusesWhatIsNoMotion) {
  const RigidSegment post = still_post(1.0, 0.0);
  RigidSegment bad = turning_rod(1.0);
  for (const double tolerance :
       {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(contact_time(bad, post, {}, tolerance), std::invalid_argument) << tolerance;
  }
  bad.after.rotation = Quaterniond(0.0, 0.0, 0.0, 0.0);
  EXPECT_THROW(contact_time(bad, post, {}, 1e-6), std::invalid_argument);
  EXPECT_THROW(contact_time(post, bad, {}, 1e-6), std::invalid_argument);
}

}  // namespace
}  // namespace fiber::test
