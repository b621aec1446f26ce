#include "src/accuracy/answer_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "test/support/answers.hpp"

namespace fiber::test {
namespace {

/// Four fibres of one segment across a fifth one, 0.1 thick, at gaps of 0, 0.1, 0.2 and 0.3.
FiberAssembly ladder() {
  std::vector<Eigen::Vector3d> points{{0, 0, 0}, {10, 0, 0}};
  for (int i = 0; i < 4; ++i) {
    points.emplace_back(1.0 + 2.0 * i, -1.0, 0.2 + 0.1 * i);
    points.emplace_back(1.0 + 2.0 * i, 1.0, 0.2 + 0.1 * i);
  }
  return {points, {0, 2, 4, 6, 8, 10}, {0.1}};
}

class AnswerErrorsTest : public testing::Test {
 protected:
  void ask(QueryType type, double margin) {
    options_.type = type;
    options_.margin = margin;
    options_.kernel = Kernel::EXACT;
    exact_ = brute_force(fibers_, options_);
    answer_ = exact_;
  }

  AnswerErrors errors() const { return answer_errors(fibers_, options_, answer_, exact_); }

  const FiberAssembly fibers_ = ladder();
  QueryOptions options_;
  QueryResult exact_;
  QueryResult answer_;
};

TEST_F(AnswerErrorsTest, ARightAnswerHasNone) {
  ask(QueryType::ALL, 0.25);
  ASSERT_EQ(exact_.contacts.size(), 3U);
  const AnswerErrors found = errors();
  EXPECT_EQ(found.expected, 3U);
  EXPECT_EQ(found.missed + found.cut_off + found.extra + found.wrong_bounds, 0U);
  EXPECT_LT(found.error, 1e-15);
  EXPECT_LT(found.bound, 1e-15);
  EXPECT_EQ(found.found_part(), 1.0);
}

TEST_F(AnswerErrorsTest, ContactsAreMissedOrCutOffOrTooMany) {
  ask(QueryType::ALL, 0.25);
  answer_.contacts.erase(answer_.contacts.begin() + 1);
  EXPECT_EQ(errors().missed, 1U);
  EXPECT_EQ(errors().cut_off, 0U);
  answer_.complete = false;
  EXPECT_EQ(errors().missed, 0U);
  EXPECT_EQ(errors().cut_off, 1U);
  EXPECT_DOUBLE_EQ(errors().found_part(), 2.0 / 3.0);
  answer_ = exact_;
  exact_.contacts.pop_back();
  EXPECT_EQ(errors().extra, 1U);
  EXPECT_EQ(errors().missed, 0U);
}

TEST_F(AnswerErrorsTest, DistancesAndBoundsAreHeldAgainstIntegers) {
  ask(QueryType::ALL, 0.25);
  answer_.contacts[2].distance += 0.01;
  EXPECT_NEAR(errors().error, 0.01, 1e-12);
  EXPECT_EQ(errors().wrong_bounds, 0U);
  answer_.contacts[2].lower = answer_.contacts[2].distance;
  EXPECT_EQ(errors().wrong_bounds, 1U);
  answer_ = exact_;
  answer_.contacts[0].upper = answer_.contacts[0].distance - 0.01;
  EXPECT_EQ(errors().wrong_bounds, 1U);
}

TEST_F(AnswerErrorsTest, OfTheClosestPairOnlyTheMinimumCounts) {
  ask(QueryType::CLOSEST, 1.0);
  ask(QueryType::ALL, 0.15);
  const Contact second = answer_.contacts[1];
  ask(QueryType::CLOSEST, 1.0);
  answer_.contacts[0] = second;
  answer_.others_lower = second.lower;
  EXPECT_NEAR(errors().error, 0.1, 1e-12);
  EXPECT_EQ(errors().missed, 0U);
  EXPECT_EQ(errors().wrong_bounds, 1U) << "nothing says that a pair may be closer";
  answer_.others_lower = -0.1;
  EXPECT_EQ(errors().wrong_bounds, 0U);
  EXPECT_NEAR(errors().bound, 0.2, 1e-12);
  answer_.contacts.clear();
  EXPECT_EQ(errors().cut_off, 1U);
}

TEST_F(AnswerErrorsTest, OfPairsOfFibersTheSegmentsMayBeOthers) {
  ask(QueryType::FIBER_PAIRS, 0.25);
  answer_.contacts[1].distance += 0.05;
  answer_.contacts[1].upper += 0.05;
  EXPECT_NEAR(errors().error, 0.05, 1e-12);
  answer_.contacts.erase(answer_.contacts.begin());
  EXPECT_EQ(errors().missed, 1U);
}

TEST(AnswerErrors, AddUpToTheWorst) {
  AnswerErrors sum;
  AnswerErrors one;
  one.expected = 4;
  one.cut_off = 1;
  one.error = 0.5;
  sum.add(one);
  one.error = 0.25;
  one.bound = 2.0;
  sum.add(one);
  EXPECT_EQ(sum.expected, 8U);
  EXPECT_EQ(sum.found_part(), 0.75);
  EXPECT_EQ(sum.error, 0.5);
  EXPECT_EQ(sum.bound, 2.0);
}

TEST_F(AnswerErrorsTest, AMissedContactIsOffByHowFarWithinTheMarginItIs) {
  ask(QueryType::ALL, 0.25);
  answer_.contacts.erase(answer_.contacts.begin() + 1);  // at a gap of 0.1
  EXPECT_NEAR(errors().decision_error, 0.15, 1e-12);
  EXPECT_NEAR(errors().largest(), 0.15, 1e-12);
  ask(QueryType::ALL, 0.25);
  options_.margin = 0.15;  // the one at a gap of 0.2 is beyond it
  exact_.contacts.pop_back();
  EXPECT_NEAR(errors().decision_error, 0.05, 1e-12);
  ask(QueryType::CLOSEST, 0.25);
  answer_.contacts.clear();
  EXPECT_NEAR(errors().decision_error, 0.25, 1e-12);
}

TEST_F(AnswerErrorsTest, OfTheClosestOnesDistancesAreHeldAgainstEachOther) {
  options_.max_contacts = 2;
  ask(QueryType::LIMITED, 1.0);
  ASSERT_EQ(exact_.contacts.size(), 2U);
  ask(QueryType::ALL, 1.0);
  const Contact farther = answer_.contacts[2];
  ask(QueryType::LIMITED, 1.0);
  answer_.contacts[1] = farther;  // at a gap of 0.2 instead of 0.1
  EXPECT_NEAR(errors().error, 0.1, 1e-12);
  EXPECT_EQ(errors().missed + errors().extra, 0U);
  answer_.contacts.pop_back();
  EXPECT_EQ(errors().missed, 1U);
  EXPECT_NEAR(errors().decision_error, 0.9, 1e-12);
}

TEST_F(AnswerErrorsTest, AnyContactIsAFirstOne) {
  ask(QueryType::ALL, 0.25);
  const Contact any = answer_.contacts[2];
  ask(QueryType::FIRST, 0.25);
  answer_.contacts[0] = any;
  EXPECT_EQ(errors().missed + errors().extra, 0U);
  EXPECT_LT(errors().largest(), 1e-15);
  answer_.contacts.clear();
  EXPECT_EQ(errors().missed, 1U);
}

TEST_F(AnswerErrorsTest, FibresOfOtherPointsAreHeldAgainstBothWays) {
  ask(QueryType::FIBER_PAIRS, 0.25);
  answer_.contacts[1].segment_b = 7;
  answer_.contacts[1].distance -= 0.05;
  EXPECT_NEAR(resampled_errors(options_, answer_, exact_).error, 0.05, 1e-12);
  answer_.contacts.pop_back();
  EXPECT_EQ(resampled_errors(options_, answer_, exact_).missed, 1U);
  ask(QueryType::CLOSEST, 0.25);
  answer_.contacts[0].distance -= 0.05;
  EXPECT_NEAR(resampled_errors(options_, answer_, exact_).error, 0.05, 1e-12);
}

}  // namespace
}  // namespace fiber::test
