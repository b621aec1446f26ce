// Queries that may report so many contacts, or examine so many pairs, and not more.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "fiber_proximity/query/brute_force.hpp"
#include "support/contacts.hpp"
#include "support/engines_test.hpp"

namespace fiber::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

using ContactLimitTest = EnginesTest;
using PairLimitTest = EnginesTest;

/// Where nearly all is near all.
FiberAssembly tangle(Random& random, int fibers) {
  AssemblyBuilder builder;
  for (int fiber = 0; fiber < fibers; ++fiber) {
    builder.add_fiber(random_walk(random, 12, 0.05));
  }
  return builder.build({0.1});
}

QueryOptions within(double margin) {
  QueryOptions options;
  options.margin = margin;
  return options;
}

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
    for (const Kernel kernel : {Kernel::FAST, Kernel::ROBUST, Kernel::EXACT}) {
      QueryOptions options = within(random.uniform(0.0, 1.0));
      options.kernel = kernel;
      QueryResult all;
      brute_force(fibers, options, all);
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
  for (const Kernel kernel : {Kernel::FAST, Kernel::ROBUST, Kernel::EXACT}) {
    for (const double margin : {0.6, infinity}) {
      QueryOptions options = within(margin);
      options.kernel = kernel;
      QueryResult all;
      brute_force(fibers, options, all);
      ASSERT_GT(all.contacts.size(), 20'000U);
      for (const std::uint32_t limit : {300U, 10'000U}) {
        options.contact_limit = limit;
        ASSERT_NO_FATAL_FAILURE(expect_closest(ask(fibers, options), all, limit));
      }
    }
  }
}

TEST_P(ContactLimitTest, TheClosestPairsOfFibersAreReported) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = tangle(random, 80);
  QueryOptions options = within(infinity);
  options.type = QueryType::FIBER_PAIRS;
  QueryResult all;
  brute_force(fibers, options, all);
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
    QueryOptions options = within(0.5);
    options.type = type;
    QueryResult all;
    brute_force_shape(shape, fibers, options, all);
    QueryResult found;
    for (const std::uint32_t limit : {1U, 100U, 100'000U}) {
      options.contact_limit = limit;
      engine->query_shape(shape, options, found);
      ASSERT_NO_FATAL_FAILURE(expect_closest(found, all, limit));
    }
  }
}

TEST_P(ContactLimitTest, LimitedReportsNoMore) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = tangle(random, 10);
  QueryResult all;
  brute_force(fibers, within(0.5), all);
  QueryOptions options = within(0.5);
  options.type = QueryType::LIMITED;
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
  constexpr std::size_t of_one_round = 16'384;  // ContactJudge's
  const QueryResult found = ask(fibers, options);
  ASSERT_EQ(found.contacts.size(), 100U);
  EXPECT_LT(found.contacts.capacity(), 2 * (2 * options.contact_limit + of_one_round + 2000));
}

INSTANTIATE_TEST_SUITE_P(Engines, ContactLimitTest, all_engines(), name_of_engine);

TEST_P(PairLimitTest, AQueryEndsAfterSoManyPairsWithWhatItHasFound) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = tangle(random, 60);
  QueryOptions options = within(0.5);
  QueryResult all;
  brute_force(fibers, options, all);
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
    QueryOptions options = within(0.5);
    options.neighbour_skip = 1;  // looks along fibres would count, too
    options.type = type;
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
  QueryResult result;
  engine->query_shape(shape, options, result);
  EXPECT_FALSE(result.complete);
  EXPECT_TRUE(result.limit_reached);
  EXPECT_LE(result.counts.primitive_tests, 100U);
  options.pair_limit = 0;
  engine->query_shape(shape, options, result);
  EXPECT_TRUE(result.complete);
  EXPECT_FALSE(result.limit_reached);
}

INSTANTIATE_TEST_SUITE_P(Engines, PairLimitTest, all_engines(), name_of_engine);

TEST(BruteForcePairLimit, CountsEachPair) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = tangle(random, 3);
  const std::uint64_t segments = fibers.segment_count();
  QueryOptions options = within(infinity);
  options.neighbour_skip = 1;  // looks along fibres would count, too
  QueryResult result;
  for (const std::uint64_t too_few : {0U, 1U}) {
    options.pair_limit = segments * (segments - 1) / 2 - too_few;
    brute_force(fibers, options, result);
    EXPECT_EQ(result.complete, too_few == 0);
    EXPECT_EQ(result.limit_reached, too_few == 1);
  }
}

/// Answers of engines of one thread and of several.
class RunTreeLimits : public testing::TestWithParam<double> {
 protected:
  static EngineOptions with_threads(std::uint32_t threads) {
    EngineOptions options;
    options.threads = threads;
    options.skin = GetParam();
    return options;
  }

  /// Of the same motion, twice: with a skin the second query has candidates of the first.
  void expect_the_same(const FiberAssembly& fibers, const QueryOptions& options) {
    const std::unique_ptr<ProximityEngine> one = make_engine("run_tree", with_threads(1));
    const std::unique_ptr<ProximityEngine> four = make_engine("run_tree", with_threads(4));
    QueryResult of_four;
    for (int round = 0; round < 2; ++round) {
      one->update(fibers);
      one->query(options, found_);
      four->update(fibers);
      four->query(options, of_four);
      ASSERT_TRUE(same_contacts(found_.contacts, of_four.contacts));
      ASSERT_EQ(found_.complete, of_four.complete);
      ASSERT_EQ(found_.limit_reached, of_four.limit_reached);
      ASSERT_EQ(found_.others_lower, of_four.others_lower);
      ASSERT_EQ(found_.counts.primitive_tests, of_four.counts.primitive_tests);
      ASSERT_EQ(found_.counts.node_tests, of_four.counts.node_tests);
    }
  }

  QueryResult found_;
};

TEST_P(RunTreeLimits, GiveTheSameForAnyNumberOfThreads) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = tangle(random, 1000);
  QueryOptions options = within(0.1);
  for (const std::uint64_t pairs : {1000U, 100'000U}) {
    for (const std::uint32_t contacts : {100U, 20'000U}) {
      SCOPED_TRACE(std::to_string(pairs) + " pairs, " + std::to_string(contacts) + " contacts");
      options.pair_limit = pairs;
      options.contact_limit = contacts;
      ASSERT_NO_FATAL_FAILURE(expect_the_same(fibers, options));
      EXPECT_FALSE(found_.complete);
      EXPECT_TRUE(found_.limit_reached);
      EXPECT_LE(found_.counts.primitive_tests, pairs);
    }
  }
}

TEST_P(RunTreeLimits, TheClosestAreFoundAmongFarMorePairsThanAreExamined) {
  SCOPED_TRACE(seed_message());
  Random random;
  AssemblyBuilder builder;
  for (int fiber = 0; fiber < 300; ++fiber) {
    builder.add_fiber(random_walk(random, 12, 0.05));
  }
  const FiberAssembly fibers = builder.build({1e-6});
  QueryOptions options = within(infinity);
  options.type = QueryType::LIMITED;
  options.max_contacts = 500;
  QueryResult expected;
  brute_force(fibers, options, expected);
  options.type = QueryType::ALL;
  options.contact_limit = 500;
  options.pair_limit = 1'000'000;
  ASSERT_NO_FATAL_FAILURE(expect_the_same(fibers, options));
  EXPECT_TRUE(same_contacts(found_.contacts, expected.contacts));
  EXPECT_TRUE(found_.complete);
  EXPECT_TRUE(found_.limit_reached);
}

INSTANTIATE_TEST_SUITE_P(Skins, RunTreeLimits, testing::Values(0.0, 0.02),
                         [](const testing::TestParamInfo<double>& skin) {
                           return skin.param > 0.0 ? "with_a_skin" : "without";
                         });

TEST_P(RunTreeLimits, HoldForAFiberThatStaysNearOnePlace) {
  SCOPED_TRACE(seed_message());
  Random random;
  AssemblyBuilder builder;
  for (int point = 0; point < 600; ++point) {
    builder.add_point(random.in_cube());
  }
  builder.end_fiber();
  // Few points are as far away as a loop needs: nearly all are looked at.
  const FiberAssembly fibers = builder.build({1.36});
  QueryOptions options;
  options.pair_limit = 300'000;  // more than there are pairs
  ASSERT_NO_FATAL_FAILURE(expect_the_same(fibers, options));
  EXPECT_FALSE(found_.complete);
  EXPECT_TRUE(found_.limit_reached);
  options.pair_limit = 0;
  ASSERT_NO_FATAL_FAILURE(expect_the_same(fibers, options));
  EXPECT_TRUE(found_.complete);
  EXPECT_FALSE(found_.limit_reached);
}

TEST(RunTreeLimitsOfSkin, CandidatesThatWereKeptDoNotServeASmallerLimit) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = tangle(random, 60);
  EngineOptions engine_options;
  engine_options.skin = 0.01;
  const std::unique_ptr<ProximityEngine> engine = make_engine("run_tree", engine_options);
  engine->update(fibers);
  QueryOptions options = within(0.1);
  QueryResult whole;
  engine->query(options, whole);
  ASSERT_TRUE(whole.complete);
  options.pair_limit = 1000;
  QueryResult found;
  engine->query(options, found);
  EXPECT_FALSE(found.complete);
  EXPECT_LE(found.counts.primitive_tests, 1000U);
  options.pair_limit = 0;
  engine->query(options, found);
  EXPECT_TRUE(found.complete);
  EXPECT_TRUE(same_contacts(found.contacts, whole.contacts));
}

}  // namespace
}  // namespace fiber::test
