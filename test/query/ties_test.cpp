// Many pairs that are as close as one another: which are reported, and at what cost.
#include <gtest/gtest.h>

#include <algorithm>

#include "test/support/answers.hpp"
#include "test/support/contacts.hpp"
#include "test/support/engines_test.hpp"
#include "test/support/query_options.hpp"
#include "test/support/tangle.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// Hairs from one root, all their first segments as deep in each other as can be.
FiberAssembly rooted(Random& random, int fibers, int segments, double radius) {
  const Vector3d root = random.in_cube();
  AssemblyBuilder builder;
  for (int fiber = 0; fiber < fibers; ++fiber) {
    std::vector<Vector3d> points = random_walk(random, segments, 0.1);
    const Vector3d offset = root - points.front();
    for (Vector3d& point : points) {
      point += offset;
    }
    points.front() = root;
    builder.add_fiber(points);
  }
  return builder.build({radius});
}

/// Fibres in the same place.
FiberAssembly coincident(Random& random, int fibers, int segments, double radius) {
  return as_fibers(
      std::vector(static_cast<std::size_t>(fibers), random_walk(random, segments, 0.1)), radius);
}

/// On a grid: each meets many, at points of the grid or along its edges.
FiberAssembly on_a_grid(Random& random, int fibers, int segments, double radius) {
  AssemblyBuilder builder;
  for (int fiber = 0; fiber < fibers; ++fiber) {
    std::vector<Vector3d> points{
        Vector3d(random.integer(0, 2), random.integer(0, 2), random.integer(0, 2))};
    for (int i = 0; i < segments; ++i) {
      Vector3d next = points.back();
      next[random.integer(0, 2)] += random.chance(0.5) ? 1.0 : -1.0;
      points.push_back(next);
    }
    builder.add_fiber(points);
  }
  return builder.build({radius});
}

/// The same fibres, a few of them thicker.
FiberAssembly some_thick(const FiberAssembly& fibers, Random& random) {
  std::vector<double> radii(fibers.fiber_count(), fibers.largest_radius());
  for (double& radius : radii) {
    radius *= random.chance(0.2) ? 2.0 : 1.0;
  }
  return {fibers.points(), fibers.offsets(), radii};
}

FiberAssembly random_ties(Random& random) {
  constexpr FiberAssembly (*makers[])(Random&, int, int, double) = {rooted, coincident, on_a_grid};
  const FiberAssembly fibers = makers[random.integer(0, 2)](
      random, random.integer(2, 40), random.integer(1, 6), random.chance(0.2) ? 0.0 : 0.01);
  return random.chance(0.3) ? some_thick(fibers, random) : fibers;
}

/// So many of the closest of all contacts: what is kept while pairs come up has no part in this.
std::vector<Contact> closest_of(std::vector<Contact> all, const QueryOptions& options) {
  std::size_t most = options.type == QueryType::CLOSEST ? 1 : options.max_contacts;
  if (options.contact_limit > 0) {
    most = std::min<std::size_t>(most, options.contact_limit);
  }
  sort_by_distance(all);
  all.resize(std::min(all.size(), most));
  sort_by_key(all);
  return all;
}

QueryOptions options_of_all(QueryOptions options) {
  options.type = QueryType::ALL;
  options.contact_limit = 0;
  return options;
}

using TiesTest = EnginesTest;

TEST_P(TiesTest, ThoseOfTheSmallestIndicesAreReported) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < rounds(150); ++round) {
    FiberAssembly fibers = random_ties(random);
    FiberAssembly shape = random.chance(0.5) ? fibers : random_ties(random);
    if (GetParam() == "AL-threaded") {
      fibers = equal_fibers(fibers);
      shape = equal_fibers(shape);
    }
    const std::unique_ptr<ProximityEngine> engine = make_engine(GetParam());
    engine->update(fibers);
    for (const QueryType type : {QueryType::CLOSEST, QueryType::LIMITED}) {
      SCOPED_TRACE("round " + std::to_string(round) + ", type " +
                   std::to_string(static_cast<int>(type)));
      const QueryOptions options = random_options(random, 1.0, type);
      const QueryResult all = brute_force(fibers, options_of_all(options));
      const QueryResult found = answer(*engine, options);
      ASSERT_TRUE(same_contacts(found.contacts, closest_of(all.contacts, options)));
      ASSERT_TRUE(found.complete);
      ASSERT_TRUE(all.contacts.empty() || found.minimum_lower() <= all.closest()->upper);
      const QueryResult of_shape = brute_force(shape, fibers, options_of_all(options));
      ASSERT_TRUE(same_contacts(answer(*engine, shape, options).contacts,
                                closest_of(of_shape.contacts, options)));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, TiesTest, engines_of_each_kind(), name_of_engine);

/// Pairs that run_tree measures to find the closest.
std::uint64_t tests_for_closest(const FiberAssembly& fibers, double tolerance = 0.0) {
  QueryOptions options = within(0.0, QueryType::CLOSEST);
  options.tolerance = tolerance;
  const QueryResult found = answer("run_tree", fibers, options);
  EXPECT_EQ(found.contacts.size(), 1U);
  return found.counts.primitive_tests;
}

/// Where nothing can be closer, only pairs of smaller indices are looked for.
TEST(RunTreeTies, TakeFarFewerTestsThanThereAre) {
  SCOPED_TRACE(seed_message());
  Random random;
  constexpr std::uint32_t count = 2000;
  EXPECT_LE(tests_for_closest(rooted(random, count, 1, 0.001)), count);
  EXPECT_LE(tests_for_closest(rooted(random, count, 10, 0.001)), count);
  EXPECT_LE(tests_for_closest(coincident(random, count, 1, 0.001)), count);
  EXPECT_LE(tests_for_closest(coincident(random, count, 1, 0.0)), count);
  for (const FiberAssembly& fibers :
       {rooted(random, count, 4, 0.001), coincident(random, count, 1, 0.001)}) {
    QueryOptions options = within(0.0, QueryType::LIMITED);
    options.max_contacts = 100;
    EXPECT_LE(answer("run_tree", fibers, options).counts.primitive_tests, 10U * count);
    const std::unique_ptr<ProximityEngine> engine = make_engine("run_tree");
    engine->update(fibers);
    options.type = QueryType::CLOSEST;
    EXPECT_LE(answer(*engine, fibers, options).counts.primitive_tests, count);
  }
}

/// What is not deeper than what has been found need not be measured: boxes tell how deep pairs can
/// be at most.
TEST(RunTreeTies, InATangleMostPairsAreToldApartByTheirBoxes) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = tangle(random, 1000);
  const std::size_t contacts = answer("run_tree", fibers).contacts.size();
  expect_enough(contacts, std::size_t{100'000});
  const std::uint64_t exactly = tests_for_closest(fibers);
  EXPECT_LE(exactly, contacts / 20);
  // A depth within a hundredth of the radius is soon found.
  EXPECT_LE(tests_for_closest(fibers, 1e-3), exactly);
}

/// As deep as can be but for the tolerance: there is nothing left to look for.
TEST(RunTreeTies, WithATolerancePairsThatAreDeepEnoughAreTheLast) {
  SCOPED_TRACE(seed_message());
  Random random;
  FiberAssembly fibers = coincident(random, 2000, 1, 0.001);
  fibers.update_points(shaken(fibers, 1e-6, random).points());
  EXPECT_LE(tests_for_closest(fibers, 1e-5), 10U);
  EXPECT_LE(tests_for_closest(rooted(random, 2000, 1, 0.001), 1e-5), 10U);
}

}  // namespace
}  // namespace fiber::test
