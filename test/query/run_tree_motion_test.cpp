// Motions in trees of segments that move: how close they are, and that they miss nothing.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "src/query/run_tree_engine.hpp"
#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"
#include "test/support/motions.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

void expect_same(const MotionResult& found, const MotionResult& expected) {
  EXPECT_EQ(found.contacts.size(), expected.contacts.size());
  EXPECT_TRUE(same(found.contacts, expected.contacts));
  EXPECT_TRUE(same(found.touching, expected.touching));
}

/// Walks of about one size.
FiberAssembly walks_in(Random& random, int fibers, int segments, double size, double radius) {
  AssemblyBuilder builder;
  for (int fiber = 0; fiber < fibers; ++fiber) {
    std::vector<Vector3d> walk = random_walk(random, segments, 0.1);
    const Vector3d place = random.in_cube(0.2);
    for (Vector3d& point : walk) {
      point = size * (point + place);
    }
    builder.add_fiber(walk);
  }
  return builder.build({radius * size});
}

/// Fibres as wholes go ways of this length, and each of their points one more.
FiberAssembly after_ways(const FiberAssembly& before, double way, double own_way, Random& random) {
  std::vector<Vector3d> points = before.points();
  for (std::size_t fiber = 0; fiber < before.fiber_count(); ++fiber) {
    const Vector3d common = way * random.in_cube();
    for (std::uint32_t i = before.offsets()[fiber]; i < before.offsets()[fiber + 1]; ++i) {
      points[i] += common + own_way * random.in_cube();
    }
  }
  return with_points(before, points);
}

FiberAssembly elsewhere(const FiberAssembly& fibers, const Vector3d& offset) {
  std::vector<Vector3d> points = fibers.points();
  for (Vector3d& point : points) {
    point += offset;
  }
  return with_points(fibers, points);
}

TEST(RunTreeMotion, FindsWhatAllPairsFindWhateverSizePlaceAndWay) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::size_t began = 0;
  std::size_t uncertain = 0;
  for (int round = 0; round < 300; ++round) {
    const double size = std::pow(10.0, random.uniform(-12.0, 12.0));
    const double radius = random.chance(0.2) ? 0.0 : random.uniform(0.0, 0.03);
    const double way = size * std::pow(10.0, random.uniform(-4.0, 1.0));
    const double own_way = random.chance(0.5) ? 0.0 : random.uniform(0.0, 1.0) * way;
    // The scene is far away, or goes far as a whole.
    const double away = random.chance(0.5) ? 0.0 : 1e6 * random.uniform(0.0, 1.0);
    const double drift = random.chance(0.5) ? 0.0 : 1e3 * random.uniform(0.0, 1.0);
    const FiberAssembly wide = walks_in(random, 1 + round % 12, 1 + round % 23, size, radius);
    std::vector<Vector3d> points = wide.points();
    flatten_some(points, random);
    const FiberAssembly before =
        elsewhere(with_points(wide, points), away * size * Vector3d(1.0, -0.5, 0.3));
    const FiberAssembly after = elsewhere(after_ways(before, way, own_way, random),
                                          drift * size * Vector3d(-0.2, 1.0, 0.4));
    MotionOptions options;
    options.margin = round % 3 == 0 ? 0.0 : random.uniform(0.0, 0.05) * size;
    options.tolerance = size * std::pow(10.0, random.uniform(-9.0, -1.0));
    options.neighbour_skip = 1;  // many contacts: neighbours' too
    MotionResult expected = expected_of(before, after, options);
    SCOPED_TRACE("round " + std::to_string(round));
    expect_same(answer("run_tree", before, after, options, 1), expected);
    began += expected.contacts.size();
    for (const MotionContact& contact : expected.contacts) {
      uncertain += contact.certain ? 0 : 1;
    }
  }
  expect_enough(began, std::size_t{1000});
  expect_enough(uncertain, std::size_t{10});
}

/// Two segments that pass each other at the margin; along the axes, too, where they have no extent
/// along one, and it is their boxes that touch.
TEST(RunTreeMotion, FindsWhatOnlyJustTouches) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < 2000; ++round) {
    Vector3d along = random.direction();
    Vector3d to_other = random.direction().cross(along).normalized();
    if (random.chance(0.5)) {
      const int axis = random.integer(0, 2);
      along = Vector3d::Unit(axis);
      to_other = Vector3d::Unit((axis + random.integer(1, 2)) % 3);
    }
    const Vector3d gap = random.uniform(0.01, 1.0) * to_other;
    const Vector3d place = 100.0 * random.in_cube();
    // The first one, which trees take their origin from, stands aside.
    const Vector3d aside = place - random.uniform(3.0, 4.0) * to_other;
    const FiberAssembly before =
        as_fibers({{aside, aside + random.uniform(0.0, 1.0) * along},
                   {place, place + random.uniform(0.0, 0.5) * along},
                   {place + gap - along, place + gap - random.uniform(1.0, 2.0) * along}});
    std::vector<Vector3d> points = before.points();
    points[4] += 3.0 * along;
    points[5] += 3.0 * along;
    MotionOptions options;
    options.margin = gap.norm() * (1.0 + 0x1p-40);
    options.tolerance = 1e-9;
    const FiberAssembly after = with_points(before, points);
    const MotionResult found = answer("run_tree", before, after, options, 1);
    expect_same(found, expected_of(before, after, options));
    EXPECT_EQ(found.contacts.size(), 1U);
  }
}

/// [m] The least distance of the first segments of two fibres at some times.
double min_distance(const FiberAssembly& before, const FiberAssembly& after) {
  constexpr int times = 64;
  double least = std::numeric_limits<double>::infinity();
  const auto point = [&](std::size_t i, double time) -> Vector3d {
    return (1.0 - time) * before.points()[i] + time * after.points()[i];
  };
  for (int i = 0; i <= times; ++i) {
    const double time = static_cast<double>(i) / times;
    least = std::min(
        least,
        segment_distance(point(0, time), point(1, time), point(2, time), point(3, time)).distance);
  }
  return least;
}

/// What comes near, but not to the margin, may be reported: then by all. That a tree alone could
/// tell so is rare: ten pairs in 100 000.
TEST(RunTreeMotion, FindsWhatIsReportedForTheToleranceAlone) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::size_t reported = 0;
  for (int round = 0; round < rounds(40000); ++round) {
    const FiberAssembly before =
        as_fibers({{random.in_cube(), random.in_cube()}, {random.in_cube(), random.in_cube()}});
    const FiberAssembly after = after_ways(before, 1.0, random.uniform(0.0, 0.3), random);
    MotionOptions options;
    options.margin = 0.7 * min_distance(before, after);
    options.tolerance = options.margin;
    const MotionResult expected = expected_of(before, after, options);
    expect_same(answer("run_tree", before, after, options, 1), expected);
    reported += expected.contacts.size();
  }
  expect_enough(reported, static_cast<std::size_t>(rounds(1000)));
}

TEST(RunTreeMotion, AnswersTheSameWithEveryInstructionSet) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly before = walks_in(random, 60, 40, 1.0, 0.02);
  const FiberAssembly after = after_ways(before, 0.3, 0.1, random);
  const MotionResult expected = expected_of(before, after, {});
  expect_enough(expected.contacts.size(), std::size_t{300});
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    SCOPED_TRACE(hwy::TargetName(target));
    expect_same(answer("run_tree", before, after, {}, 2), expected);
  }
  hwy::SetSupportedTargetsForTest(0);
}

/// What makes whole scenes fast: segments are not as thick as their way is long.
TEST(RunTreeMotion, LooksAtHardlyMorePairsThanCome) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly before = walks_in(random, 300, 40, 1.0, 0.001);
  for (const double way : {0.01, 0.1}) {
    const MotionResult result =
        answer("run_tree", before, after_ways(before, way, 0.0, random), {}, 1);
    const std::size_t found = result.contacts.size() + result.touching.size();
    expect_enough(found, std::size_t{100});
    EXPECT_LE(result.counts.primitive_tests, 3 * found);
  }
}

TEST(RunTreeMotion, LeavesNoTreeForFibersThatStand) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly before = walks_in(random, 80, 40, 1.0, 0.02);
  const FiberAssembly after = after_ways(before, 0.002, 0.001, random);
  RunTreeEngine engine({1, 0.1});  // a tree that stands would serve
  QueryResult result;
  MotionResult motion;
  engine.update(before);
  engine.query({}, result);
  engine.update_motion(before, after);
  engine.query_motion({}, motion);
  for (const FiberAssembly* fibers : {&after, &before}) {
    engine.update(*fibers);
    engine.query({}, result);
    RunTreeEngine fresh({1});
    fresh.update(*fibers);
    const QueryResult expected = answer(fresh);
    expect_enough(expected.contacts.size(), std::size_t{100});
    EXPECT_TRUE(same_contacts(result.contacts, expected.contacts));
    EXPECT_TRUE(
        same_contacts(answer(engine, before, {}).contacts, answer(fresh, before, {}).contacts));
  }
}

}  // namespace
}  // namespace fiber::test
