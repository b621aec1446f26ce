// Queries about motions: every engine finds what all pairs, one by one, find.
#include "fiber_proximity/query/motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "fiber_proximity/query/for_engines/narrow_phase.hpp"
#include "src/query/contact_evaluator.hpp"
#include "test/query/motion_queries.hpp"
#include "test/support/answers.hpp"
#include "test/support/error_of.hpp"
#include "test/support/not_finite.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// [m] About the size of a segment with its radius: what a motion is measured by.
double size_of(const FiberAssembly& fibers) {
  double size = fibers.largest_radius();
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const std::uint32_t first = fibers.offsets()[fiber];
    size = std::max(size, (fibers.points()[first + 1] - fibers.points()[first]).norm());
  }
  return size;
}

/// Every point goes its own way, and all together one more.
FiberAssembly moved(const FiberAssembly& fibers, double way, Random& random) {
  std::vector<Vector3d> points = shaken(fibers, way, random).points();
  const Vector3d common = 3.0 * way * random.in_cube();
  for (Vector3d& point : points) {
    point += common;
  }
  return with_points(fibers, points);
}

TEST_P(MotionQueries, FindWhatAllPairsFind) {
  std::size_t began = 0;
  std::size_t touched = 0;
  for_each_assembly(1, [&](const FiberAssembly& before, Random& random) {
    for (const double part : {0.0, 0.1, 3.0}) {
      const FiberAssembly after = moved(before, part * size_of(before), random);
      MotionOptions options;
      options.margin = random.chance(0.5) ? 0.0 : 0.2 * size_of(before);
      options.tolerance = 1e-6 * size_of(before);
      options.pairing = static_cast<Pairing>(random.integer(0, 2));
      if (random.chance(0.5)) {
        options.neighbour_skip = static_cast<std::uint32_t>(random.integer(0, 3));
      }
      const MotionResult expected = expected_of(before, after, options);
      const MotionResult found = ask_motion(before, after, options);
      ASSERT_EQ(found.contacts.size(), expected.contacts.size());
      ASSERT_TRUE(same(found.contacts, expected.contacts));
      ASSERT_TRUE(same(found.touching, expected.touching));
      began += expected.contacts.size();
      touched += expected.touching.size();
    }
  });
  expect_enough(began, static_cast<std::size_t>(rounds(100)));
  expect_enough(touched, static_cast<std::size_t>(rounds(100)));
}

TEST_P(MotionQueries, WithoutMotionThoseInContactAreAll) {
  for_each_assembly(1, [&](const FiberAssembly& fibers, Random&) {
    QueryOptions pairs;
    pairs.kernel = Kernel::EXACT;
    const QueryResult contacts = ask(fibers, pairs);
    MotionOptions options;
    options.tolerance = 0.0;
    const MotionResult result = ask_motion(fibers, fibers, options);
    ASSERT_EQ(result.touching.size(), contacts.contacts.size());
    for (std::size_t i = 0; i < result.touching.size(); ++i) {
      ASSERT_EQ(result.touching[i].key(), contacts.contacts[i].key());
    }
    ASSERT_TRUE(result.contacts.empty());
  });
}

TEST_P(MotionQueries, AShapeThatMovesMeetsFibersThatMove) {
  for_each_assembly(1, [&](const FiberAssembly& before, Random& random) {
    const FiberAssembly after = moved(before, size_of(before), random);
    const FiberAssembly shape_before = moved(before, size_of(before), random);
    const FiberAssembly shape_after = moved(before, 2.0 * size_of(before), random);
    const std::unique_ptr<ProximityEngine> engine = make_engine(GetParam());
    MotionOptions options;
    options.tolerance = 1e-6 * size_of(before);
    MotionResult found;
    engine->update_motion(before, after);
    engine->query_motion_shape(shape_before, shape_after, options, found);
    MotionResult expected;
    for (const std::uint32_t a : segments_of(before)) {
      for (const std::uint32_t b : segments_of(before)) {
        SegmentMotions motions = motions_of(before, after, {a, b}, 0.0);
        motions.a_before = &shape_before.points()[a];
        motions.a_after = &shape_after.points()[a];
        const ContactTime time = contact_time(motions, options.tolerance);
        if (time.hit) {
          const SegmentId id_a = before.segment_id(a);
          const SegmentId id_b = before.segment_id(b);
          (time.certain && time.upper == 0.0 ? expected.touching : expected.contacts)
              .push_back({id_a.fiber, id_a.segment, id_b.fiber, id_b.segment, time.lower,
                          time.upper, time.certain});
        }
      }
    }
    ASSERT_TRUE(same(found.contacts, expected.contacts));
    ASSERT_TRUE(same(found.touching, expected.touching));
  });
}

TEST_P(MotionQueries, AfterAMotionAnUpdateAnswersAsEver) {
  for_each_assembly(1, [&](const FiberAssembly& before, Random& random) {
    const FiberAssembly after = moved(before, size_of(before), random);
    const std::unique_ptr<ProximityEngine> engine = make_engine(GetParam());
    engine->update_motion(before, after);
    QueryResult result;
    EXPECT_THROW(engine->query({}, result), std::logic_error);
    engine->update(after);
    engine->query({}, result);
    const QueryResult fresh = ask(after, {});
    ASSERT_EQ(result.contacts.size(), fresh.contacts.size());
    for (std::size_t i = 0; i < fresh.contacts.size(); ++i) {
      ASSERT_EQ(result.contacts[i].key(), fresh.contacts[i].key());
      ASSERT_EQ(result.contacts[i].distance, fresh.contacts[i].distance);
    }
    MotionResult motion;
    EXPECT_THROW(engine->query_motion({}, motion), std::logic_error);
  });
}

TEST_P(MotionQueries, ACableThatPassesThroughAnotherBetweenFramesIsCaught) {
  const FiberAssembly before = crossed_cables(0.1);
  const FiberAssembly after = crossed_cables(-0.1);
  EXPECT_TRUE(ask(before, {}).contacts.empty());
  EXPECT_TRUE(ask(after, {}).contacts.empty());
  MotionOptions options;
  options.tolerance = 1e-9;
  const MotionResult result = ask_motion(before, after, options);
  ASSERT_EQ(result.contacts.size(), 1U);
  const MotionContact& contact = result.contacts.front();
  const double truth = (0.1 - 0.004) / 0.2;
  EXPECT_TRUE(contact.certain);
  EXPECT_LE(contact.lower, truth);
  EXPECT_GE(contact.upper, truth);
  EXPECT_LE(contact.upper - contact.lower, 1e-8);
  EXPECT_EQ(contact.fiber_a, 0U);
  EXPECT_EQ(contact.fiber_b, 1U);
  EXPECT_TRUE(result.touching.empty());
}

TEST_P(MotionQueries, FibersHaveTheLargerOfTheirRadii) {
  const FiberAssembly thin = crossed_cables(0.1);
  const FiberAssembly thick(thin.points(), thin.offsets(), {0.04});
  std::vector<Vector3d> points = thin.points();
  for (std::size_t i = points.size() / 2; i < points.size(); ++i) {
    points[i].z() = 0.075;
  }
  const FiberAssembly thin_after = with_points(thin, points);
  const FiberAssembly thick_after = with_points(thick, points);
  EXPECT_TRUE(ask_motion(thin, thin_after, {}).contacts.empty());
  const MotionResult grows = ask_motion(thin, thick_after, {});
  EXPECT_FALSE(grows.contacts.empty());
  EXPECT_TRUE(same(grows.contacts, ask_motion(thick, thin_after, {}).contacts));
  EXPECT_TRUE(same(grows.contacts, ask_motion(thick, thick_after, {}).contacts));
}

TEST_P(MotionQueries, BadInputIsRefused) {
  const FiberAssembly before = crossed_cables(0.1);
  const std::unique_ptr<ProximityEngine> engine = make_engine(GetParam());
  MotionResult result;
  EXPECT_THROW(engine->query_motion({}, result), std::logic_error);
  const FiberAssembly one = as_fibers({straight(0.0, true)}, 0.002);
  EXPECT_EQ(
      error_of([&] { engine->update_motion(before, one); }),
      "the fibres change their topology: 2 of 42 points before, 1 of 21 after; a motion needs "
      "the same fibres with the same numbers of points");
  EXPECT_THROW(engine->query_motion({}, result), std::logic_error) << "nothing half updated";

  engine->update_motion(before, before);
  for (const double tolerance : {-1e-9, infinity, std::nan("")}) {
    MotionOptions options;
    options.tolerance = tolerance;
    EXPECT_THROW(engine->query_motion(options, result), std::invalid_argument) << tolerance;
  }
  for (const double tolerance : {-1e-9, std::nan("")}) {
    MotionOptions options;
    options.time_tolerance = tolerance;
    EXPECT_NE(error_of([&] { engine->query_motion(options, result); }).find("time_tolerance is "),
              std::string::npos)
        << tolerance;
  }
  MotionOptions options;
  options.type = MotionType::LIMITED;
  options.max_contacts = 0;
  EXPECT_THROW(engine->query_motion(options, result), std::invalid_argument);
  options = {};
  options.margin = -1.0;
  EXPECT_THROW(engine->query_motion(options, result), std::invalid_argument);

  std::vector<Vector3d> far = before.points();
  far.front().x() = 1e150;
  far.back().x() = -1e150;
  std::vector<Vector3d> back = before.points();
  back.front().x() = -1e150;
  back.back().x() = 1e150;
  const FiberAssembly from = with_points(before, far);
  const FiberAssembly to = with_points(before, back);
  EXPECT_NE(
      error_of([&] { engine->update_motion(from, to); }).find("fibre 0, segment 0: moves so far"),
      std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(All, MotionQueries, all_engines(), name_of_engine);

TEST(MotionQueriesOnThreads, AnswerTheSame) {
  Random random;
  const FiberAssembly before = walks(random, 200, 20, 0.05, 0.004);
  const FiberAssembly after = moved(before, 0.05, random);
  const MotionResult expected = answer("run_tree", before, after, {}, 1);
  expect_enough(expected.contacts.size(), std::size_t{100});
  for (const std::uint32_t threads : {2U, 4U}) {
    const MotionResult result = answer("run_tree", before, after, {}, threads);
    EXPECT_TRUE(same(result.contacts, expected.contacts) &&
                same(result.touching, expected.touching));
  }
}

}  // namespace
}  // namespace fiber::test
