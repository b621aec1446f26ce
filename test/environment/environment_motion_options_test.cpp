// Questions about fibres that move among objects: what the options ask for, and what is refused.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "test/environment/motion_scene.hpp"
#include "test/support/error_of.hpp"
#include "test/support/not_finite.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

const Eigen::Isometry3d unmoved = Eigen::Isometry3d::Identity();

bool same(const MotionContact& x, const MotionContact& y) {
  return x.key() == y.key() && x.lower == y.lower && x.upper == y.upper && x.certain == y.certain;
}

std::vector<MotionContact> by_time(std::vector<MotionContact> contacts) {
  std::sort(contacts.begin(), contacts.end(),
            [](const MotionContact& x, const MotionContact& y) { return x.earlier_than(y); });
  return contacts;
}

TEST(EnvironmentMotion, TheEarliestAreThoseOfAllWithinTheLimits) {
  SCOPED_TRACE(seed_message());
  Random random;
  int several = 0;
  for (int round = 0; round < rounds(50); ++round) {
    MotionScene scene = random_scene(random, 1.0, ObjectMotion::STRAIGHT);
    const MotionResult all = scene.ask();
    const std::vector<MotionContact> ordered = by_time(all.contacts);
    if (ordered.size() < 4) {
      continue;
    }
    ++several;
    scene.options.type = MotionType::FIRST;
    const MotionResult first = scene.ask();
    ASSERT_EQ(first.contacts.size(), 1U);
    EXPECT_TRUE(same(first.contacts[0], ordered[0]));
    EXPECT_EQ(first.others_lower, ordered[1].lower);
    EXPECT_EQ(first.touching.size(), all.touching.size());
    scene.options.type = MotionType::LIMITED;
    scene.options.max_contacts = 3;
    const std::vector<MotionContact> three = by_time(scene.ask().contacts);
    ASSERT_EQ(three.size(), 3U);
    EXPECT_TRUE(same(three[2], ordered[2]));
    scene.options.type = MotionType::ALL;
    scene.options.contact_limit = 2;
    EXPECT_EQ(scene.ask().contacts.size(), 2U);
    EXPECT_TRUE(scene.ask().limit_reached);
    scene.options.pair_limit = 1;
    const MotionResult none = scene.ask();
    EXPECT_TRUE(none.contacts.empty() && none.limit_reached && !none.complete);
    EXPECT_EQ(none.others_lower, 0.0);
    scene.options.pair_limit = 0;
    scene.options.deadline = 1e-9;
    EXPECT_FALSE(scene.ask().complete);
  }
  expect_enough(several, rounds(10));
}

TEST(EnvironmentMotion, AllowedPairsMayMeet) {
  const EnvironmentObject plate{"plate", unmoved, {{BoxShape{{1.0, 1.0, 1e-3}}}}};
  const FiberAssembly before = cable(straight_cable(0.1), 1e-3);
  const FiberAssembly after = cable(straight_cable(-0.1), 1e-3);
  EXPECT_EQ(ask({plate}, before, after, {}).contacts.size(), 10U);
  EXPECT_EQ(ask({plate}, before, after, {}, {{"plate", 0, 2, 4}}).contacts.size(), 7U);
  EXPECT_EQ(ask({plate}, before, after, {}, {{"", 0, 0, -1}}).contacts.size(), 0U);
}

TEST(EnvironmentMotion, ObjectsAreTheSameBeforeAndAfter) {
  const EnvironmentObject box{"box", unmoved, {{BoxShape{{1.0, 1.0, 1.0}}}}};
  const FiberAssembly fiber({{2.0, 0.0, 0.0}, {2.0, 0.1, 0.0}}, {0, 2}, {1e-3});
  EnvironmentObject moved = box;
  moved.pose.translation().x() = 4.0;
  EnvironmentObject other = moved;
  other.name = "other";
  EnvironmentObject larger = moved;
  larger.shapes[0].shape = BoxShape{{1.0, 1.0, 2.0}};
  MotionResult result;
  const auto contacts_with = [&](const std::vector<EnvironmentObject>& later) {
    Environment({box}).query_motion(fiber, fiber, Environment(later), {}, {}, result);
    return result.contacts.size();
  };
  EXPECT_EQ(contacts_with({moved}), 1U);
  EXPECT_NEAR(result.contacts[0].lower, (2.0 - 0.5 - 1e-3) / 4.0, 1e-6);
  EXPECT_EQ(contacts_with({other}), 0U) << "one that is not there later stands still";
  EXPECT_EQ(error_of([&] { contacts_with({larger}); }),
            "object 'box' changes its shapes during the motion, it may only move");
}

TEST(EnvironmentMotion, BadInputIsRefused) {
  const EnvironmentObject box{"box", unmoved, {{BoxShape{{1.0, 1.0, 1.0}}}}};
  const FiberAssembly two({{2.0, 0.0, 0.0}, {2.0, 0.1, 0.0}}, {0, 2}, {1e-3});
  const FiberAssembly three({{2.0, 0.0, 0.0}, {2.0, 0.1, 0.0}, {3.0, 0.0, 0.0}}, {0, 3}, {1e-3});
  EXPECT_NE(error_of([&] { ask({box}, two, three, {}); }).find("change their topology"),
            std::string::npos);
  for (const double tolerance : {-1e-9, infinity, std::nan("")}) {
    MotionOptions options;
    options.tolerance = tolerance;
    EXPECT_THROW(ask({box}, two, two, options), std::invalid_argument) << tolerance;
  }
  MotionOptions options;
  options.margin = -1.0;
  EXPECT_THROW(ask({box}, two, two, options), std::invalid_argument);
  EnvironmentObject turned = box;
  turned.pose.linear() = Eigen::AngleAxisd(1.0, Vector3d::UnitY()).toRotationMatrix();
  options = {};
  options.tolerance = 0.0;
  MotionResult result;
  EXPECT_EQ(error_of([&] {
              Environment({box}).query_motion(two, two, Environment({turned}), options, {}, result);
            }),
            "the tolerance is 0 m, where objects turn it must be more");
  options.margin = infinity;
  EXPECT_EQ(ask({box}, two, two, options).touching.size(), 1U);
}

TEST(EnvironmentMotion, ExtremeCoordinatesAreNoDanger) {
  const EnvironmentObject box{"box", unmoved, {{BoxShape{{1.0, 1.0, 1.0}}}}};
  constexpr double far = 1e150;
  const FiberAssembly before({{-far, far, 0.0}, {-far, -far, 0.0}}, {0, 2}, {1e-3});
  const FiberAssembly after({{far, far, 0.0}, {far, -far, 0.0}}, {0, 2}, {1e-3});
  const MotionResult result = ask({box}, before, after, {});
  ASSERT_EQ(result.contacts.size(), 1U);
  EXPECT_LE(result.contacts[0].lower, 0.5);
  const FiberAssembly tiny({{1e-300, 0.0, 3e-300}, {0.0, 0.0, 3e-300}}, {0, 2}, {0.0});
  const FiberAssembly tiny_after({{1e-300, 0.0, -3e-300}, {0.0, 0.0, -3e-300}}, {0, 2}, {0.0});
  const EnvironmentObject sheet{"sheet", unmoved, {{PlaneShape{}}}};
  EXPECT_EQ(ask({sheet}, tiny, tiny_after, {}).contacts.size(), 1U);
}

TEST(EnvironmentMotionOnThreads, AnswersTheSame) {
  SCOPED_TRACE(seed_message());
  Random random;
  MotionScene scene = random_scene(random, 1.0, ObjectMotion::TURNING);
  std::vector<Vector3d> points = random_cable(random, 1.0, rounds(200));
  scene.fibers_before = cable(points, 0.01);
  for (Vector3d& point : points) {
    point += random.in_cube(0.2);
  }
  scene.fibers_after = cable(points, 0.01);
  MotionResult expected;
  for (const std::size_t threads : {1U, 2U, 4U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const MotionResult result = scene.ask();
    if (threads == 1) {
      expected = result;
      expect_enough(result.contacts.size(), std::size_t{10});
    }
    ASSERT_EQ(result.contacts.size(), expected.contacts.size());
    for (std::size_t i = 0; i < expected.contacts.size(); ++i) {
      EXPECT_TRUE(same(result.contacts[i], expected.contacts[i]));
    }
  }
}

}  // namespace
}  // namespace fiber::test
