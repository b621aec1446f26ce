#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fiber_proximity/query/motion.hpp"
#include "test/query/motion_queries.hpp"
#include "test/support/answers.hpp"

namespace fiber::test {
namespace {

constexpr double cable_radius = 0.002;  // [m] of crossed_cables()

/// What one engine finds of the only pair that meets.
MotionContact only_contact(const FiberMotion& motion, const MotionOptions& options) {
  const MotionResult result = answer("run_tree", motion.before, motion.after, options);
  EXPECT_EQ(result.contacts.size(), 1U);
  return result.contacts.at(0);
}

TEST(ContactInMotion, IsSeenWhereItBegins) {
  const FiberAssembly before = crossed_cables(0.1);
  const FiberAssembly after = crossed_cables(-0.3);
  const FiberMotion motion{before, after};
  MotionOptions options;
  options.tolerance = 1e-9;
  const MotionContact contact = only_contact(motion, options);
  const Contact first = first_contact(motion, motion, contact);
  EXPECT_EQ(first.fiber_a, 0U);
  EXPECT_EQ(first.segment_a, contact.segment_a);
  EXPECT_EQ(first.fiber_b, 1U);
  EXPECT_EQ(first.segment_b, contact.segment_b);
  EXPECT_NEAR(first.distance, 0.0, 1e-9);
  EXPECT_NEAR(first.point_a.z(), cable_radius, 1e-9);
  EXPECT_NEAR(first.point_a.x(), 0.01, 1e-9);
  EXPECT_NEAR(first.normal.z(), 1.0, 1e-9);
  EXPECT_EQ(time_of(contact), contact.upper);
  // Where no time of contact was found, before it.
  MotionContact without_upper = contact;
  without_upper.upper = std::numeric_limits<double>::infinity();
  without_upper.lower = 0.0;
  EXPECT_EQ(time_of(without_upper), 0.0);
  EXPECT_NEAR(first_contact(motion, motion, without_upper).distance, 0.1 - 2 * cable_radius, 1e-12);
}

TEST(ContactInMotion, IsKnownToEnd) {
  const FiberAssembly before = crossed_cables(0.1);
  const FiberAssembly after = crossed_cables(-0.3);
  const FiberMotion motion{before, after};
  for (const double margin : {0.0, 0.001}) {
    MotionOptions options;
    options.margin = margin;
    options.tolerance = 1e-9;
    const LastContact last =
        last_contacts(motion, motion, {only_contact(motion, options)}, options).at(0);
    const double truth = (0.1 + 2 * cable_radius + margin) / 0.4;
    EXPECT_FALSE(last.lasts);
    EXPECT_LE(last.lower, truth);
    EXPECT_GE(last.upper, truth);
    EXPECT_LE(last.upper - last.lower, 1e-8);
  }
}

TEST(ContactInMotion, MayLast) {
  const FiberAssembly before = crossed_cables(0.1);
  const FiberAssembly after = crossed_cables(0.001);
  const FiberMotion motion{before, after};
  const MotionContact contact = only_contact(motion, {});
  const LastContact last = last_contacts(motion, motion, {contact}, {}).at(0);
  EXPECT_TRUE(last.lasts);
  EXPECT_GE(last.upper, 1.0);
  EXPECT_LE(last.lower, 1.0);
  EXPECT_GE(last.lower, 1.0 - 1e-12);
}

TEST(ContactInMotion, HasTheLargerRadius) {
  const FiberAssembly before = crossed_cables(0.1);
  const FiberAssembly thicker(before.points(), before.offsets(), {0.01});
  for (const FiberMotion& motion : {FiberMotion{before, thicker}, FiberMotion{thicker, before}}) {
    EXPECT_EQ(capsule_at(motion, 0, 0.0).radius, 0.01);
    EXPECT_EQ(capsule_at(motion, 0, 1.0).radius, 0.01);
  }
}

}  // namespace
}  // namespace fiber::test
