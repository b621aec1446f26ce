#include "fiber_proximity/geometry/contact_time.hpp"

#include <gtest/gtest.h>
#include <hwy/highway.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "test/support/not_finite.hpp"
#include "test/support/public_edge_motions.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"
#include "validation/geometry/hard_motions.hpp"
#include "validation/geometry/motion_score.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

ContactTime time_of(const HardMotion& motion, double tolerance) {
  return contact_time(motion.motions(), tolerance);
}

bool same(const ContactTime& x, const ContactTime& y) {
  return x.hit == y.hit && x.lower == y.lower && x.upper == y.upper && x.certain == y.certain;
}

std::string described(const ContactTime& time) {
  std::ostringstream text;
  text.precision(17);
  text << (time.hit ? "hit in [" : "no hit, [") << time.lower << ", " << time.upper
       << (time.certain ? "], certain" : "]");
  return text.str();
}

/// Two segments of one metre at right angles, with a gap of one metre between axes, of which the
/// upper one comes down by two metres.
HardMotion falling(double radius) {
  HardMotion motion;
  motion.a_before[0] = {-0.5, 0.0, 1.0};
  motion.a_before[1] = {0.5, 0.0, 1.0};
  motion.a_after[0] = {-0.5, 0.0, -1.0};
  motion.a_after[1] = {0.5, 0.0, -1.0};
  motion.b_before[0] = motion.b_after[0] = {0.0, -0.5, 0.0};
  motion.b_before[1] = motion.b_after[1] = {0.0, 0.5, 0.0};
  motion.radius_a = radius;
  motion.radius_b = radius;
  return motion;
}

TEST(ContactTime, IsThatOfCapsulesWhichMeet) {
  for (const double radius : {0.25, 0.1, 1e-3, 1e-9}) {
    const ContactTime time = time_of(falling(radius), 1e-9);
    const double truth = 0.5 * (1.0 - 2.0 * radius);
    EXPECT_TRUE(time.hit && time.certain) << described(time);
    EXPECT_LE(time.lower, truth);
    EXPECT_GE(time.upper, truth);
    EXPECT_LE(time.upper - time.lower, 1e-9);
  }
}

TEST(ContactTime, SegmentsWithoutThicknessCross) {
  const ContactTime time = time_of(falling(0.0), 1e-9);
  EXPECT_TRUE(time.hit && time.certain) << described(time);
  EXPECT_LE(time.lower, 0.5);
  EXPECT_GE(time.upper, 0.5);
  EXPECT_LE(time.upper - time.lower, 1e-9);
}

TEST(ContactTime, TheMarginCounts) {
  const HardMotion motion = falling(0.1);
  SegmentMotions wider = motion.motions();
  wider.limit.margin = 0.3;
  const ContactTime time = contact_time(wider, 1e-9);
  EXPECT_TRUE(time.hit && time.certain);
  EXPECT_NEAR(time.lower, 0.25, 1e-9);
  wider.limit.margin = infinity;
  EXPECT_TRUE(same(contact_time(wider, 1e-9), {true, 0.0, 0.0, true}));
}

TEST(ContactTime, WhatPassesByIsNoHit) {
  HardMotion motion = falling(0.1);
  for (Vector3d* ends : {motion.a_before.data(), motion.a_after.data()}) {
    ends[0].x() += 0.71;
    ends[1].x() += 0.71;
  }
  EXPECT_TRUE(same(time_of(motion, 1e-6), {false, 1.0, infinity, true}));
}

TEST(ContactTime, AContactAtTheBeginningIsDecidedExactly) {
  HardMotion motion = falling(0.5);  // the axes are 1 m apart: the capsules touch
  EXPECT_TRUE(same(time_of(motion, 1e-6), {true, 0.0, 0.0, true}));
  motion.radius_a = std::nextafter(0.5, 0.0);
  const ContactTime approaching = time_of(motion, 0.0);
  EXPECT_TRUE(approaching.hit && approaching.certain);
  EXPECT_GT(approaching.upper, 0.0) << "by less than a rounding, but they do not touch";
  // The same that goes away, or stays.
  motion.a_after[0].z() = motion.a_after[1].z() = 3.0;
  EXPECT_FALSE(time_of(motion, 0.0).hit);
  motion.a_after[0] = motion.a_before[0];
  motion.a_after[1] = motion.a_before[1];
  EXPECT_FALSE(time_of(motion, 0.0).hit);
}

TEST(ContactTime, WhatComesWithinTheToleranceOnlyIsNeverCertain) {
  for (const double gap : {1e-3, 1e-5, 1e-7, 1e-9, 1e-12}) {
    HardMotion motion = falling(0.1);
    motion.a_after[0].z() = motion.a_after[1].z() = 0.2 + gap;
    const ContactTime time = time_of(motion, 1e-6);
    EXPECT_FALSE(time.hit && time.certain) << gap;
    EXPECT_FALSE(time.hit && gap > 1e-6) << gap;
  }
}

TEST(ContactTime, RefusesAToleranceThatIsNone) {
  const HardMotion motion = falling(0.1);
  for (const double tolerance : {-1e-9, -infinity, std::nan("")}) {
    EXPECT_THROW(time_of(motion, tolerance), std::invalid_argument);
  }
}

// Found by scripts/bench.sh continuous: bounds on the time wider than 20 T/L, where segments came
// nearer ever more slowly between reaching the tolerance and contact.
TEST(ContactTime, BoundsAreNarrowWhereSegmentsSlowDown) {
  const auto crossing =
      std::find_if(motion_families().begin(), motion_families().end(),
                   [](const MotionFamily& family) { return family.name == "crossing"; });
  const HardMotion crossed = hard_motions(*crossing, 2000, 77)[925];
  const double tolerance = 0x1.c3c4010f0721bp-10;
  const ContactTime time = time_of(crossed, tolerance);
  EXPECT_TRUE(time.hit) << described(time);
  EXPECT_FALSE(judge(crossed, tolerance, time).has_wrong_answers()) << described(time);

  HardMotion swapped;
  swapped.a_before[0] = {-0x1.be221ba91721p-1, -0x1.0e8eceb416e34p-1, 0x1.4acea1987aa28p-2};
  swapped.a_before[1] = {-0x1.25b9fa2750085p+0, -0x1.0e066162f13bp-3, 0x1.49ab64c98145p-3};
  swapped.b_before[0] = {-0x1.be8b30c074b4p-2, -0x1.46f08ae5cf85cp-1, 0x1.c01366d486e1ep-1};
  swapped.b_before[1] = {-0x1.ed628c1bf25e2p-2, -0x1.2d6784f02805cp-3, 0x1.338a795c24c89p+0};
  swapped.a_after[0] = {-0x1.e6a328a53f474p-2, -0x1.0adf1acef6ea6p-1, 0x1.40336a5b09474p-1};
  swapped.a_after[1] = {-0x1.961f544ce6988p-3, -0x1.d5ed3f3b88b82p-1, 0x1.92faf0ec7fb8ap-1};
  swapped.b_after[0] = {-0x1.363a4f94827bfp-1, -0x1.a15be92e2e4f2p-2, 0x1.9bfd591317ed4p-2};
  swapped.b_after[1] = {-0x1.1ecea1e6c3a6ep-1, -0x1.cc449e40dcabep-1, 0x1.37e9052e4a3bp-4};
  swapped.radius_a = 0.038457164813706785;
  swapped.radius_b = 0.007520568640004277;
  const ContactTime turned = time_of(swapped, 0.0010403602577176796);
  EXPECT_TRUE(turned.hit && turned.certain) << described(turned);
  EXPECT_FALSE(judge(swapped, 0.0010403602577176796, turned).has_wrong_answers())
      << described(turned);
}

std::vector<std::string> family_names() {
  std::vector<std::string> names;
  for (const MotionFamily& family : motion_families()) {
    names.push_back(family.name);
  }
  return names;
}

class MotionFamilies : public testing::TestWithParam<std::string> {
 protected:
  static std::vector<HardMotion> motions(std::uint32_t count) {
    const auto family =
        std::find_if(motion_families().begin(), motion_families().end(),
                     [](const MotionFamily& other) { return other.name == GetParam(); });
    return hard_motions(*family, count, run_seed());
  }

  /// Where segments miss each other by a rounding, the judge needs thousands of bits: 4 of 5
  /// seconds of all families.
  static std::uint32_t judged_count() {
    return static_cast<std::uint32_t>(
        rounds(GetParam() == "crossing, but for a rounding" ? 25 : 100));
  }

  /// Segments without thickness are within less than a rounding of each other for less time than
  /// doubles tell apart.
  static bool has_thickness(const HardMotion& motion) {
    return motion.radius_a + motion.radius_b > 1e-9 * extent_of(motion);
  }
};

TEST_P(MotionFamilies, NoContactIsMissedAndNoneIsInvented) {
  SCOPED_TRACE(seed_message());
  for (const double part : {1e-2, 1e-6, 1e-9, 1e-12, 1e-15, 1e-18, 0.0}) {
    for (const HardMotion& motion : motions(judged_count())) {
      const double tolerance = part * extent_of(motion);
      const ContactTime answer = time_of(motion, tolerance);
      EXPECT_FALSE(judge(motion, tolerance, answer).has_wrong_answers())
          << described(answer) << ", tolerance " << tolerance;
      EXPECT_TRUE(answer.hit ? answer.lower <= answer.upper : same(answer, ContactTime()));
      if (part >= 1e-12 || has_thickness(motion)) {
        EXPECT_FALSE(answer.hit && std::isinf(answer.upper)) << "tolerance " << tolerance;
      }
    }
  }
}

TEST_P(MotionFamilies, AContactAtTheBeginningIsDecidedExactly) {
  SCOPED_TRACE(seed_message());
  std::size_t touching = 0;
  std::size_t apart = 0;
  for (const HardMotion& motion : motions(rounds(100))) {
    SegmentMotions pair = motion.motions();
    const auto& a = pair.a_before;
    const auto& b = pair.b_before;
    const double distance = segment_distance(a[0], a[1], b[0], b[1]).distance;
    // By more than rounding, by about that, and by a margin that takes most of the radii back.
    for (const double part : {0.5, 1.0 - 1e-13, 1.0 - 1e-15, 1.0, 1.0 + 1e-15, 1.0 + 1e-13, 2.0}) {
      for (const double margin : {0.0, -1e6 * distance}) {
        const double radius = (part * distance - margin) / 3.0;
        pair.limit = {radius, part * distance - margin - radius, margin};
        const ContactTime time = contact_time(pair, 1e-6 * extent_of(motion));
        const bool is_touching = exact_gap_at_most(a[0], a[1], b[0], b[1], pair.limit);
        EXPECT_EQ(time.hit && time.certain && time.upper == 0.0, is_touching)
            << described(time) << ", " << part << " of the distance " << distance;
        ++(is_touching ? touching : apart);
      }
    }
  }
  EXPECT_GT(touching, 0U);
  EXPECT_GT(apart, 0U);
}

TEST_P(MotionFamilies, OneAnswerInAnyBatchAndOnAnyInstructionSet) {
  SCOPED_TRACE(seed_message());
  const std::vector<HardMotion> all = motions(rounds(100));
  std::vector<SegmentMotions> queries;
  std::vector<ContactTime> expected;
  for (const HardMotion& motion : all) {
    queries.push_back(motion.motions());
    expected.push_back(contact_time(queries.back(), 1e-9));
  }
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    std::vector<ContactTime> found(queries.size());
    contact_times(queries.data(), queries.size(), 1e-9, found.data());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_TRUE(same(found[i], expected[i])) << hwy::TargetName(target) << ", motion " << i;
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

INSTANTIATE_TEST_SUITE_P(All, MotionFamilies, testing::ValuesIn(family_names()),
                         [](const auto& family) { return test_name(family.param); });

TEST(PublicEdgeMotions, NoneIsMissed) {
  const std::vector<KnownMotion> motions = public_edge_motions();
  if (motions.empty()) {
    GTEST_SKIP() << "no public edge motions at " << public_edge_motions_path();
  }
  for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-12}) {
    int collisions = 0;
    int near_hits = 0;
    for (const auto& [set, collides, motion] : motions) {
      const ContactTime answer = time_of(motion, tolerance);
      EXPECT_TRUE(answer.hit || !collides);
      EXPECT_FALSE(answer.hit && answer.certain && !collides);
      EXPECT_FALSE(judge(motion, tolerance, answer).has_wrong_answers());
      collisions += collides ? 1 : 0;
      near_hits += answer.hit && !collides ? 1 : 0;
    }
    EXPECT_EQ(collisions, 47);
    // Of those that miss, 69 come within 1e-6 and 30 within 1e-12.
    EXPECT_LE(near_hits, tolerance > 1e-6 ? 1016 : (tolerance > 1e-12 ? 69 : 30));
  }
}

}  // namespace
}  // namespace fiber::test
