// Objects that move by displacements, as a prediction has them: the first contact is held against a
// fine sampling of the assumed motion.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "test/environment/motion_scene.hpp"
#include "test/support/error_of.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double no_time = std::numeric_limits<double>::infinity();

/// The first of many times at which one of the pairs that are apart at first is within the margin.
double first_sampled(const MotionScene& scene, double margin) {
  constexpr int times = 300;
  const auto segments = static_cast<std::uint32_t>(scene.fibers_before.segment_count());
  double first = no_time;
  for (std::uint32_t segment = 0; segment < segments; ++segment) {
    for (std::uint32_t object = 0; object < scene.before.size(); ++object) {
      if (scene.gap(segment, object, 0.0) <= scene.options.margin) {
        continue;
      }
      for (int i = 1; i <= times && static_cast<double>(i) / times < first; ++i) {
        const double time = static_cast<double>(i) / times;
        first = scene.gap(segment, object, time) <= margin ? time : first;
      }
    }
  }
  return first;
}

TEST(MovingObjects, TheFirstContactIsWithinItsBounds) {
  SCOPED_TRACE(seed_message());
  Random random;
  int found = 0;
  int free = 0;
  for (int round = 0; round < rounds(100); ++round) {
    MotionScene scene = random_scene(random, 1.0, ObjectMotion::DISPLACED);
    if (random.chance(0.5)) {
      scene.fibers_after = scene.fibers_before;  // only objects move
    }
    scene.options.type = MotionType::FIRST;
    const MotionResult result = scene.ask();
    const MotionContact* const first = result.earliest();
    const double lower =
        first == nullptr ? result.others_lower : std::min(first->lower, result.others_lower);
    const double sampled = first_sampled(scene, scene.options.margin - 1e-12);
    EXPECT_TRUE(result.complete);
    if (first == nullptr) {
      EXPECT_EQ(lower, 1.0);
      EXPECT_EQ(sampled, no_time);
      ++free;
      continue;
    }
    ++found;
    ASSERT_LE(lower, sampled);
    ASSERT_LE(first->lower, first->upper);
    const double gap = scene.gap(first->segment_a, first->fiber_b, first->upper);
    ASSERT_LE(gap, scene.options.margin + scene.options.tolerance + 1e-12);
    if (first->certain) {
      ASSERT_LE(gap, scene.options.margin + 1e-12);
    }
  }
  expect_enough(found, 50);
  expect_enough(free, 10);
}

const Isometry3d at_origin = Isometry3d::Identity();

/// An arm along x, 1 m long and 2 cm thick, that turns about the origin.
const EnvironmentObject arm{
    "arm",
    at_origin,
    {{CapsuleShape{0.01, 1.0},
      Isometry3d(Eigen::Translation3d(0.5, 0, 0) *
                 Eigen::AngleAxisd(std::acos(-1.0) / 2.0, Vector3d::UnitY()))}}};

TEST(MovingObjects, AnArmThatTurnsTwiceMeetsWhatItTurnsTo) {
  constexpr double pi = 3.14159265358979323846;
  const Environment environment({arm});
  // A cable along z at 200°, so that the arm comes to it on a way that no shorter one replaces.
  const double at = 200.0 / 180.0 * pi;
  const Vector3d foot(0.5 * std::cos(at), 0.5 * std::sin(at), 0.0);
  const FiberAssembly fiber({foot - Vector3d(0, 0, 0.1), foot + Vector3d(0, 0, 0.1)}, {0, 2},
                            {5e-3});
  const double half_width = std::asin(0.015 / 0.5);
  MotionResult result;
  for (const double turn : {4.0 * pi, -4.0 * pi, 1.2 * pi}) {
    environment.query_motion(fiber, fiber, {{Vector3d::Zero(), Vector3d(0, 0, turn)}}, {}, {},
                             result);
    ASSERT_EQ(result.contacts.size(), 1U) << turn;
    const double way = turn > 0.0 ? at : 2.0 * pi - at;
    const double truth = (way - half_width) / std::abs(turn);
    EXPECT_LE(result.contacts[0].lower, truth);
    EXPECT_GE(result.contacts[0].upper, truth - 1e-7);
    EXPECT_LT(result.contacts[0].upper - result.contacts[0].lower, 1e-5);
  }
  environment.query_motion(fiber, fiber, {{Vector3d::Zero(), Vector3d(0, 0, 1.0 * pi)}}, {}, {},
                           result);
  EXPECT_TRUE(result.contacts.empty());
  EXPECT_EQ(result.others_lower, 1.0);
}

TEST(MovingObjects, WhatGoesAlongWithACableNeverMeetsIt) {
  const Environment environment({arm});
  const FiberAssembly before({{0.0, 0.0, 0.02}, {0.9, 0.0, 0.02}}, {0, 2}, {5e-3});
  const FiberAssembly after({{3.0, 1.0, 0.02}, {3.9, 1.0, 0.02}}, {0, 2}, {5e-3});
  MotionResult result;
  const auto contacts_of = [&](const Vector3d& translation) {
    environment.query_motion(before, after, {{translation, Vector3d::Zero()}}, {}, {}, result);
    return result.contacts.size();
  };
  EXPECT_EQ(contacts_of({3.0, 1.0, 0.0}), 0U);
  EXPECT_EQ(result.others_lower, 1.0);
  EXPECT_EQ(contacts_of({3.0, 1.0, 0.01}), 1U);
  EXPECT_NEAR(result.contacts[0].lower, 0.5, 1e-3);
}

TEST(MovingObjects, ManyAreFoundAsFewAre) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::size_t found = 0;
  for (int round = 0; round < rounds(20); ++round) {
    // Balls, some of which stand still, and a wall: all at once, and each by itself.
    std::vector<EnvironmentObject> balls;
    std::vector<ObjectDisplacement> displacements;
    for (int i = 0; i < 150; ++i) {
      const Isometry3d pose(Eigen::Translation3d(random.in_cube(1.0)));
      const Isometry3d in_ball(Eigen::Translation3d(random.in_cube(0.1)));
      balls.push_back({"ball" + std::to_string(i), pose, {{SphereShape{0.04}, in_ball}}});
      displacements.emplace_back();
      if (random.chance(0.8)) {
        displacements.back() = {random.in_cube(0.3), random.in_cube(2.0)};
      }
    }
    balls.push_back({"wall", at_origin, {{PlaneShape{Vector3d::UnitZ(), -0.7}}}});
    displacements.push_back({Vector3d(0, 0, 0.5), Vector3d::Zero()});
    const FiberAssembly before = cable(random_cable(random, 1.0, 30), 5e-3);
    const FiberAssembly after = before;
    MotionResult all;
    Environment(balls).query_motion(before, after, displacements, {}, {}, all);
    std::size_t count = 0;
    for (std::size_t i = 0; i < balls.size(); ++i) {
      MotionResult one;
      Environment({balls[i]}).query_motion(before, after, {displacements[i]}, {}, {}, one);
      for (const MotionContact& contact : one.contacts) {
        const auto same =
            std::find_if(all.contacts.begin(), all.contacts.end(), [&](const MotionContact& each) {
              return each.fiber_b == i && each.segment_a == contact.segment_a &&
                     each.lower == contact.lower && each.upper == contact.upper;
            });
        EXPECT_NE(same, all.contacts.end()) << i;
      }
      count += one.contacts.size();
    }
    EXPECT_EQ(all.contacts.size(), count);
    found += count;
  }
  expect_enough(found, std::size_t{100});
}

TEST(MovingObjects, BadDisplacementsAreRefused) {
  const FiberAssembly fiber({{0, 0, 1}, {1, 0, 1}}, {0, 2}, {5e-3});
  MotionOptions options;
  const auto error_with = [&](const std::vector<ObjectDisplacement>& displacements) {
    MotionResult result;
    return error_of(
        [&] { Environment({arm}).query_motion(fiber, fiber, displacements, options, {}, result); });
  };
  const Vector3d zero = Vector3d::Zero();
  EXPECT_EQ(error_with({}), "there are 0 displacements of 1 objects, there must be one of each");
  EXPECT_EQ(error_with({{Vector3d(no_time, 0, 0), zero}}),
            "the displacement of object 'arm': coordinates must be finite and at most 1e150 m in "
            "magnitude");
  EXPECT_EQ(error_with({{zero, Vector3d(0, 0, 101)}}),
            "the displacement of object 'arm': it turns by 101.000000 rad, it must be at most "
            "100.000000");
  EXPECT_NE(error_with({{zero, Vector3d(0, 0, std::nan(""))}}), "no error");
  EXPECT_EQ(error_with({{zero, Vector3d(0, 0, 100)}}), "no error");
  options.tolerance = 0.0;
  EXPECT_EQ(error_with({{zero, Vector3d(0, 0, 1)}}),
            "the tolerance is 0 m, where objects turn it must be more");
  EXPECT_EQ(error_with({{Vector3d(0, 0, 0.1), zero}}), "no error");
}

}  // namespace
}  // namespace fiber::test
