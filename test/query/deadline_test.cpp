// What is left of an answer that a deadline cuts off.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "test/support/answers.hpp"
#include "test/support/contacts.hpp"
#include "test/support/engines_test.hpp"
#include "test/support/random.hpp"

namespace fiber::test {
namespace {

constexpr QueryType types[] = {QueryType::FIRST, QueryType::CLOSEST, QueryType::LIMITED,
                               QueryType::ALL, QueryType::FIBER_PAIRS};

using DeadlineTest = EnginesTest;

FiberAssembly many_walks(Random& random) { return walks(random, 30, 50, 0.05, 0.02); }

TEST_P(DeadlineTest, ADeadlineLeavesAnAnswerThatIsTrue) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = many_walks(random);
  for (const QueryType type : types) {
    QueryOptions options;
    const QueryResult all = ask(fibers, options);
    options.type = type;
    const QueryResult whole = ask(fibers, options);
    const std::vector<double> deadlines{1e-9, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e3};
    for (const double deadline : sampled(deadlines, random)) {
      SCOPED_TRACE("type " + std::to_string(static_cast<int>(type)) + ", deadline " +
                   std::to_string(deadline));
      options.deadline = deadline;
      const QueryResult found = ask(fibers, options);
      for (const Contact& contact : found.contacts) {
        ASSERT_TRUE(contains(all.contacts, contact));
      }
      ASSERT_LE(found.minimum_lower(), all.closest()->upper);
      if (found.complete) {
        ASSERT_TRUE(same_contacts(found.contacts, whole.contacts));
      } else {
        ASSERT_EQ(found.others_lower, -(1.0 + 0x1p-51) * 0.04);
      }
      if (deadline == 1e-9 && type != QueryType::FIRST) {
        ASSERT_FALSE(found.complete);
      }
      if (deadline == 1e3) {
        ASSERT_TRUE(found.complete);
      }
    }
  }
}

TEST_P(DeadlineTest, ADeadlineHoldsForShapesToo) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = many_walks(random);
  const FiberAssembly shape = many_walks(random);
  const std::unique_ptr<ProximityEngine> engine = make_engine(GetParam());
  engine->update(fibers);
  QueryOptions options;
  options.deadline = 1e-9;
  EXPECT_FALSE(answer(*engine, shape, options).complete);
  options.deadline = 0.0;
  EXPECT_TRUE(answer(*engine, shape, options).complete);
}

INSTANTIATE_TEST_SUITE_P(Engines, DeadlineTest, engines_of_each_kind(), name_of_engine);

TEST(RunTreeDeadline, ADeadlineCutsOffCandidatesThatWereKept) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = many_walks(random);
  const std::unique_ptr<ProximityEngine> engine = make_engine("run_tree", {1, 0.01});
  QueryOptions options;
  engine->update(fibers);
  const QueryResult whole = answer(*engine, options);  // the next one only judges
  ASSERT_TRUE(whole.complete);
  options.deadline = 1e-9;
  QueryResult found = answer(*engine, options);
  EXPECT_FALSE(found.complete);
  EXPECT_TRUE(found.contacts.empty());
  EXPECT_LT(found.minimum_lower(), -0.03);
  options.deadline = 0.0;
  found = answer(*engine, options);
  EXPECT_TRUE(found.complete);
  EXPECT_TRUE(same_contacts(found.contacts, whole.contacts));
}

/// What is found and not judged is no answer: where all is near all, most of the time is for
/// judging.
TEST(RunTreeDeadline, NoMoreIsFoundThanCanBeJudged) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers =
      as_fibers(std::vector(std::size_t{6000}, random_walk(random, 1, 0.1)), 0.01);
  const std::unique_ptr<ProximityEngine> engine = make_engine("run_tree", {1});
  engine->update(fibers);
  constexpr double min_seconds_for_one = 1e-7;  // slower machines find no more for that
  constexpr double one_more_look = 1e4;
  QueryOptions options;
  QueryResult found;
  // Whatever else the machine does, some time is enough for some contacts.
  for (options.deadline = 0.01; found.contacts.empty(); options.deadline *= 2.0) {
    found = answer(*engine, options);
    ASSERT_LE(static_cast<double>(found.counts.primitive_tests),
              options.deadline / min_seconds_for_one + one_more_look);
  }
  EXPECT_FALSE(found.complete);
  EXPECT_EQ(found.others_lower, -(1.0 + 0x1p-51) * 0.02);
}

TEST(RunTreeDeadline, WhatADeadlineLeavesIsNotKept) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = many_walks(random);
  const std::unique_ptr<ProximityEngine> engine = make_engine("run_tree", {1, 0.01});
  engine->update(fibers);
  QueryOptions options;
  options.deadline = 1e-9;
  ASSERT_FALSE(answer(*engine, options).complete);
  options.deadline = 0.0;
  const QueryResult found = answer(*engine, options);
  const QueryResult expected = brute_force(fibers, options);
  EXPECT_TRUE(found.complete);
  EXPECT_TRUE(same_contacts(found.contacts, expected.contacts));
}

}  // namespace
}  // namespace fiber::test
