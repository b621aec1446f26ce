// Queries that may report so many contacts, or examine so many pairs, and not more.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "test/support/answers.hpp"
#include "test/support/contacts.hpp"
#include "test/support/engines_test.hpp"
#include "test/support/not_finite.hpp"
#include "test/support/tangle.hpp"

namespace fiber::test {
namespace {

using ContactLimitTest = EnginesTest;
using PairLimitTest = EnginesTest;

/// What a query must give that may report so many of these contacts.
void expect_closest(const QueryResult& found, const QueryResult& all, std::uint32_t limit) {
  std::vector<Contact> expected = all.contacts;
  sort_by_distance(expected);
  double others_lower = infinity;
  while (expected.size() > limit) {
    others_lower = std::min(others_lower, expected.back().lower);
    expected.pop_back();
  }
  sort_by_key(expected);
  ASSERT_TRUE(same_contacts(found.contacts, expected));
  ASSERT_EQ(found.limit_reached, all.contacts.size() > limit);
  ASSERT_TRUE(found.complete);
  ASSERT_LE(found.others_lower, others_lower);
}

TEST_P(ContactLimitTest, TheClosestAreReportedOnEveryFamily) {
  for_each_assembly(1, [&](const FiberAssembly& fibers, Random& random) {
    for (const Kernel kernel : {Kernel::ROBUST, Kernel::EXACT}) {
      QueryOptions options = within(random.uniform(0.0, 1.0));
      options.kernel = kernel;
      const QueryResult all = brute_force(fibers, options);
      const auto count = static_cast<std::uint32_t>(all.contacts.size());
      for (const std::uint32_t limit : {1U, count / 2, count, count + 1}) {
        if (limit > 0) {
          SCOPED_TRACE(std::to_string(limit) + " of " + std::to_string(count));
          options.contact_limit = limit;
          ASSERT_NO_FATAL_FAILURE(expect_closest(ask(fibers, options), all, limit));
        }
      }
    }
  });
}

TEST_P(ContactLimitTest, TheClosestOfVeryManyAreReported) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = tangle(random, 60);
  std::vector<QueryOptions> queries;
  for (const Kernel kernel : {Kernel::ROBUST, Kernel::EXACT}) {
    for (const double margin : {0.6, infinity}) {
      queries.push_back(within(margin));
      queries.back().kernel = kernel;
    }
  }
  for (QueryOptions options : sampled(queries, random)) {
    const QueryResult all = brute_force(fibers, options);
    ASSERT_GT(all.contacts.size(), 20'000U);
    for (const std::uint32_t limit : {300U, 10'000U}) {
      options.contact_limit = limit;
      ASSERT_NO_FATAL_FAILURE(expect_closest(ask(fibers, options), all, limit));
    }
  }
}

TEST_P(ContactLimitTest, TheClosestPairsOfFibersAreReported) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = tangle(random, 80);
  QueryOptions options = within(infinity, QueryType::FIBER_PAIRS);
  const QueryResult all = brute_force(fibers, options);
  ASSERT_GT(all.contacts.size(), 3000U);
  for (const std::uint32_t limit : {1U, 300U, 2000U, 5000U}) {
    options.contact_limit = limit;
    ASSERT_NO_FATAL_FAILURE(expect_closest(ask(fibers, options), all, limit));
  }
}

TEST_P(ContactLimitTest, TheClosestToAShapeAreReported) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = tangle(random, 30);
  const FiberAssembly shape = tangle(random, 10);
  const std::unique_ptr<ProximityEngine> engine = make_engine(GetParam());
  engine->update(fibers);
  for (const QueryType type : {QueryType::ALL, QueryType::FIBER_PAIRS}) {
    QueryOptions options = within(0.5, type);
    const QueryResult all = brute_force(shape, fibers, options);
    for (const std::uint32_t limit : {1U, 100U, 100'000U}) {
      options.contact_limit = limit;
      ASSERT_NO_FATAL_FAILURE(expect_closest(answer(*engine, shape, options), all, limit));
    }
  }
}

/// A net of 128 fibres along x and as many across them, each so far above [m]: as many pairs as
/// are judged in one round. Then ten pairs of short fibres by themselves, a distance apart [m].
FiberAssembly net_and_pairs(const std::function<double(std::uint32_t)>& height, double apart) {
  constexpr std::uint32_t count = 128;
  constexpr double spacing = 8.0;  // [m]
  constexpr double length = count * spacing;
  std::vector<Eigen::Vector3d> points;
  for (std::uint32_t i = 0; i < count; ++i) {
    points.emplace_back(-spacing, spacing * i, 0.0);
    points.emplace_back(length, spacing * i, 0.0);
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    points.emplace_back(spacing * i, -spacing, height(i));
    points.emplace_back(spacing * i, length, height(i));
  }
  for (std::uint32_t i = 0; i < 10; ++i) {
    const double y = spacing * i;
    points.emplace_back(2.0 * length - 0.25, y, 0.0);
    points.emplace_back(2.0 * length + 0.25, y, 0.0);
    points.emplace_back(2.0 * length, y - 0.25, apart);
    points.emplace_back(2.0 * length, y + 0.25, apart);
  }
  std::vector<std::uint32_t> offsets;
  for (std::uint32_t point = 0; point <= points.size(); point += 2) {
    offsets.push_back(point);
  }
  return {std::move(points), std::move(offsets), {0.0}};
}

TEST_P(ContactLimitTest, WhatIsCloserByLessThanAnErrorIsReported) {
  // Distances of the long fibres may be off by more than the short ones are closer.
  const FiberAssembly fibers = net_and_pairs([](std::uint32_t) { return 1.0; }, 1.0 - 0x1p-44);
  QueryOptions options = within(1.5);
  const QueryResult all = brute_force(fibers, options);
  options.contact_limit = 300;
  ASSERT_NO_FATAL_FAILURE(expect_closest(ask(fibers, options), all, 300));
}

TEST_P(ContactLimitTest, WhatIsNearerThanWhatWasLeftOutBeforeBoundsTheOthers) {
  const FiberAssembly fibers =
      net_and_pairs([](std::uint32_t i) { return i < 2 ? 1.0 : 1.4; }, 1.2);
  QueryOptions options = within(1.5);
  const QueryResult all = brute_force(fibers, options);
  options.contact_limit = 256;  // those of the first two across
  ASSERT_NO_FATAL_FAILURE(expect_closest(ask(fibers, options), all, 256));
}

TEST_P(ContactLimitTest, LimitedReportsNoMore) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = tangle(random, 10);
  const QueryResult all = brute_force(fibers, within(0.5));
  QueryOptions options = within(0.5, QueryType::LIMITED);
  options.max_contacts = 0xFFFF'FFFFU;
  options.contact_limit = 20;
  ASSERT_NO_FATAL_FAILURE(expect_closest(ask(fibers, options), all, 20));
}

TEST_P(ContactLimitTest, FewMoreThanTheLimitAreInMemory) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = tangle(random, 60);
  QueryOptions options = within(infinity);
  options.contact_limit = 100;
  constexpr std::size_t of_one_round = 16'384;  // ContactEvaluator's
  const QueryResult found = ask(fibers, options);
  ASSERT_EQ(found.contacts.size(), 100U);
  EXPECT_LT(found.contacts.capacity(), 2 * (2 * options.contact_limit + of_one_round + 2000));
}

INSTANTIATE_TEST_SUITE_P(Engines, ContactLimitTest, engines_of_each_kind(), name_of_engine);

TEST_P(PairLimitTest, AQueryEndsAfterSoManyPairsWithWhatItHasFound) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = tangle(random, 60);
  QueryOptions options = within(0.5);
  const QueryResult all = brute_force(fibers, options);
  for (const QueryType type :
       {QueryType::CLOSEST, QueryType::LIMITED, QueryType::ALL, QueryType::FIBER_PAIRS}) {
    SCOPED_TRACE("type " + std::to_string(static_cast<int>(type)));
    options.type = type;
    options.max_contacts = 10;
    options.pair_limit = 20;
    const QueryResult found = ask(fibers, options);
    ASSERT_FALSE(found.complete);
    ASSERT_TRUE(found.limit_reached);
    ASSERT_LE(found.counts.primitive_tests, 20U);
    ASSERT_LE(found.minimum_lower(), all.closest()->upper);
    for (const Contact& contact : found.contacts) {
      ASSERT_TRUE(contains(all.contacts, contact));
    }
    ASSERT_TRUE(same_contacts(ask(fibers, options).contacts, found.contacts));
  }
}

TEST_P(PairLimitTest, AQueryThatStaysWithinItIsComplete) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = tangle(random, 20);
  const std::uint64_t segments = fibers.segment_count();
  for (const QueryType type : {QueryType::FIRST, QueryType::CLOSEST, QueryType::LIMITED,
                               QueryType::ALL, QueryType::FIBER_PAIRS}) {
    QueryOptions options = within(0.5, type);
    options.neighbour_skip = 1;  // looks along fibres would count, too
    const QueryResult whole = ask(fibers, options);
    options.pair_limit = segments * (segments - 1) / 2;
    const QueryResult found = ask(fibers, options);
    ASSERT_TRUE(found.complete);
    ASSERT_EQ(found.limit_reached, whole.limit_reached);
    ASSERT_TRUE(same_contacts(found.contacts, whole.contacts));
  }
}

TEST_P(PairLimitTest, HoldsForShapesToo) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = tangle(random, 30);
  const FiberAssembly shape = tangle(random, 30);
  const std::unique_ptr<ProximityEngine> engine = make_engine(GetParam());
  engine->update(fibers);
  QueryOptions options = within(0.5);
  options.pair_limit = 100;
  QueryResult result = answer(*engine, shape, options);
  EXPECT_FALSE(result.complete);
  EXPECT_TRUE(result.limit_reached);
  EXPECT_LE(result.counts.primitive_tests, 100U);
  options.pair_limit = 0;
  result = answer(*engine, shape, options);
  EXPECT_TRUE(result.complete);
  EXPECT_FALSE(result.limit_reached);
}

INSTANTIATE_TEST_SUITE_P(Engines, PairLimitTest, engines_of_each_kind(), name_of_engine);

TEST(BruteForcePairLimit, CountsEachPair) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = tangle(random, 3);
  const std::uint64_t segments = fibers.segment_count();
  QueryOptions options = within(infinity);
  options.neighbour_skip = 1;  // looks along fibres would count, too
  for (const std::uint64_t too_few : {0U, 1U}) {
    options.pair_limit = segments * (segments - 1) / 2 - too_few;
    const QueryResult result = brute_force(fibers, options);
    EXPECT_EQ(result.complete, too_few == 0);
    EXPECT_EQ(result.limit_reached, too_few == 1);
  }
}

}  // namespace
}  // namespace fiber::test
