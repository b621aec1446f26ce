// Limits of contacts and pairs where several threads share the work, and where candidates are kept.
#include <gtest/gtest.h>

#include <memory>

#include "test/support/answers.hpp"
#include "test/support/contacts.hpp"
#include "test/support/not_finite.hpp"
#include "test/support/rounds.hpp"
#include "test/support/tangle.hpp"

namespace fiber::test {
namespace {

/// Answers of engines of one thread and of several.
class RunTreeLimits : public testing::TestWithParam<double> {
 protected:
  /// Of the same motion, twice: with a skin the second query has candidates of the first.
  void expect_the_same(const FiberAssembly& fibers, const QueryOptions& options) {
    const std::unique_ptr<ProximityEngine> one = make_engine("run_tree", {1, GetParam()});
    const std::unique_ptr<ProximityEngine> four = make_engine("run_tree", {4, GetParam()});
    for (int round = 0; round < 2; ++round) {
      one->update(fibers);
      one->query(options, found_);
      four->update(fibers);
      const QueryResult of_four = answer(*four, options);
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
  QueryOptions closest = within(0.1, QueryType::LIMITED);
  closest.max_contacts = 100;
  for (const std::uint64_t pairs : {1000U, 100'000U}) {
    for (const std::uint32_t contacts : {100U, 20'000U}) {
      SCOPED_TRACE(std::to_string(pairs) + " pairs, " + std::to_string(contacts) + " contacts");
      options.pair_limit = pairs;
      options.contact_limit = contacts;
      ASSERT_NO_FATAL_FAILURE(expect_the_same(fibers, options));
      EXPECT_TRUE(found_.limit_reached);
      EXPECT_LE(found_.counts.primitive_tests, pairs);
      // Few that are deep rule the others out: so many pairs are enough to find them.
      const bool is_enough = pairs == 100'000 && contacts == 100;
      EXPECT_EQ(found_.complete, is_enough);
      if (is_enough && rounds_less == 1) {  // sanitizers have nothing to see in brute force
        static const QueryResult expected = brute_force(fibers, closest);  // for all skins
        EXPECT_TRUE(same_contacts(found_.contacts, expected.contacts));
      }
    }
  }
}

TEST_P(RunTreeLimits, TheClosestAreFoundAmongFarMorePairsThanAreExamined) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = walks(random, 300, 12, 0.05, 1e-6);
  QueryOptions options = within(infinity, QueryType::LIMITED);
  options.max_contacts = 500;
  const QueryResult expected = brute_force(fibers, options);
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
  const std::unique_ptr<ProximityEngine> engine = make_engine("run_tree", {0, 0.01});
  engine->update(fibers);
  QueryOptions options = within(0.1);
  const QueryResult whole = answer(*engine, options);
  ASSERT_TRUE(whole.complete);
  options.pair_limit = 1000;
  QueryResult found = answer(*engine, options);
  EXPECT_FALSE(found.complete);
  EXPECT_LE(found.counts.primitive_tests, 1000U);
  options.pair_limit = 0;
  found = answer(*engine, options);
  EXPECT_TRUE(found.complete);
  EXPECT_TRUE(same_contacts(found.contacts, whole.contacts));
}

}  // namespace
}  // namespace fiber::test
