// Queries about motions: the earliest contacts, how well their times are known, limits and
// deadlines.
#include <cmath>

#include "fiber_proximity/query/motion.hpp"
#include "test/query/motion_queries.hpp"
#include "test/support/answers.hpp"
#include "test/support/not_finite.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

std::vector<MotionContact> by_time(std::vector<MotionContact> contacts) {
  std::sort(contacts.begin(), contacts.end(),
            [](const MotionContact& x, const MotionContact& y) { return x.earlier_than(y); });
  return contacts;
}

TEST_P(MotionQueries, TheEarliestAreThoseOfAll) {
  const FiberAssembly before = crossed_cables(0.1);
  const FiberAssembly after = crossed_cables(-0.1);
  MotionOptions options;
  options.margin = 0.06;
  const MotionResult all = ask_motion(before, after, options);
  EXPECT_EQ(all.others_lower, 1.0);
  const std::vector<MotionContact> ordered = by_time(all.contacts);
  ASSERT_GT(ordered.size(), 3U);
  ASSERT_NE(all.earliest(), nullptr);
  EXPECT_TRUE(same({*all.earliest()}, {ordered.front()}));

  options.type = MotionType::FIRST;
  const MotionResult first = ask_motion(before, after, options);
  ASSERT_EQ(first.contacts.size(), 1U);
  EXPECT_TRUE(same(first.contacts, {ordered.front()}));
  EXPECT_EQ(first.others_lower, ordered[1].lower);
  EXPECT_FALSE(first.limit_reached);
  EXPECT_TRUE(same(first.touching, all.touching));

  options.type = MotionType::LIMITED;
  options.max_contacts = 3;
  const MotionResult three = ask_motion(before, after, options);
  EXPECT_TRUE(same(by_time(three.contacts), {ordered.begin(), ordered.begin() + 3}));
  EXPECT_EQ(three.others_lower, ordered[3].lower);
  EXPECT_TRUE(three.limit_reached);
}

/// They come nearer ever more slowly, and overlap by less than the tolerance in the end.
TEST_P(MotionQueries, BoundsOnTheTimeAreAsNearAsIsAsked) {
  const FiberAssembly before =
      as_fibers({{{-0.5, 0.0, 0.0}, {0.5, 0.0, 0.0}}, {{0.0, -0.5, 0.1}, {0.0, 0.5, 0.1}}}, 0.01);
  std::vector<Vector3d> points = before.points();
  points[2].z() = points[3].z() = 0.02 - 0.5e-3;
  const FiberAssembly after = with_points(before, points);
  const double truth = (0.1 - 0.02) / (0.1 - points[2].z());
  MotionOptions options;
  options.tolerance = 1e-2;
  double width = 1.0;
  for (const double most : {infinity, 1e-3, 1e-6, 1e-9, 0.0}) {
    options.time_tolerance = most;
    const MotionResult result = ask_motion(before, after, options);
    ASSERT_EQ(result.contacts.size(), 1U);
    const MotionContact& contact = result.contacts.front();
    EXPECT_TRUE(contact.certain);
    EXPECT_LE(contact.lower, truth);
    EXPECT_GE(contact.upper, truth * (1.0 - 1e-15));
    EXPECT_LE(contact.upper - contact.lower, std::max(most, 1e-14));
    EXPECT_LE(contact.upper - contact.lower, width);
    width = contact.upper - contact.lower;
    if (most == infinity) {
      EXPECT_GT(width, 1e-3) << "as the tolerance makes them";
    }
  }
}

TEST_P(MotionQueries, LimitsAreKeptAndTold) {
  const FiberAssembly before = crossed_cables(0.1);
  const FiberAssembly after = crossed_cables(-0.1);
  MotionOptions options;
  options.margin = 0.06;
  const std::vector<MotionContact> all = by_time(ask_motion(before, after, options).contacts);
  ASSERT_GT(all.size(), 2U);
  options.contact_limit = 2;
  const MotionResult two = ask_motion(before, after, options);
  EXPECT_TRUE(same(by_time(two.contacts), {all.begin(), all.begin() + 2}));
  EXPECT_TRUE(two.limit_reached);
  options.contact_limit = 0;
  options.pair_limit = 1;
  const MotionResult none = answer(GetParam(), before, after, options);
  EXPECT_TRUE(none.contacts.empty() && none.limit_reached && !none.complete);
  EXPECT_EQ(none.others_lower, 0.0);
}

/// What a deadline leaves is true, and says that it is not all.
TEST_P(MotionQueries, ADeadlineLeavesAnAnswerThatIsTrue) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly before = walks(random, 40, 30, 0.08, 0.01);
  const FiberAssembly after = shaken(before, 0.3, random);
  const std::unique_ptr<ProximityEngine> engine = make_engine(GetParam());
  engine->update_motion(before, after);
  MotionOptions options;
  options.neighbour_skip = 1;
  MotionResult all;
  engine->query_motion(options, all);
  ASSERT_TRUE(all.complete);
  expect_enough(all.contacts.size(), std::size_t{50});
  for (const double deadline : {1e-9, 1e-5, 1e-4, 1e-3, 1e-2, 1e3}) {
    SCOPED_TRACE(deadline);
    options.deadline = deadline;
    MotionResult found;
    engine->query_motion(options, found);
    for (const MotionContact& contact : found.contacts) {
      const auto same_pair = std::lower_bound(
          all.contacts.begin(), all.contacts.end(), contact,
          [](const MotionContact& x, const MotionContact& y) { return x.key() < y.key(); });
      ASSERT_NE(same_pair, all.contacts.end());
      ASSERT_TRUE(same({contact}, {*same_pair}));
    }
    if (found.complete) {
      ASSERT_TRUE(same(found.contacts, all.contacts) && same(found.touching, all.touching));
    } else {
      ASSERT_EQ(found.others_lower, 0.0);
    }
    if (deadline == 1e-9) {
      ASSERT_FALSE(found.complete);
    }
    if (deadline == 1e3) {
      ASSERT_TRUE(found.complete);
    }
  }
}

}  // namespace
}  // namespace fiber::test
