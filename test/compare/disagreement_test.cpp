#include <gtest/gtest.h>

#include <limits>

#include "src/compare/pair_oracle.hpp"
#include "test/support/not_finite.hpp"

namespace fiber::test {
namespace {

/// Two segments that cross at a gap of exactly 1 m, by claims of an ulp and more.
class PairOracleTest : public testing::Test {
 protected:
  Verdict verdict(const std::optional<PairClaim>& ours, const std::optional<PairClaim>& fcl,
                  double margin = 1.0, Kernel kernel = Kernel::ROBUST) const {
    QueryOptions options;
    options.margin = margin;
    options.kernel = kernel;
    const Disagreement found = PairOracle(fibers_, options).judge({0, 2}, ours, fcl, true);
    EXPECT_EQ(found.gap, 1.0);
    EXPECT_EQ(found.is_contact, margin >= 1.0);
    return found.verdict;
  }

  static constexpr double ulp = std::numeric_limits<double>::epsilon();
  static constexpr double below = 1.0 - 0.5 * ulp;
  static constexpr PairClaim exact{1.0, 1.0, 1.0};
  static constexpr PairClaim too_near{0.5, 0.5, below};
  static constexpr PairClaim too_far{1.5, 1.0 + ulp, 2.0};

 private:
  const FiberAssembly fibers_{
      {{-1, 0, 0}, {1, 0, 0}, {0, -1, 1.5}, {0, 1, 1.5}}, {0, 2, 4}, {0.25}};
};

TEST_F(PairOracleTest, HoldsClaimsAgainstTheTruthToTheLastDigit) {
  EXPECT_EQ(verdict(exact, exact), Verdict::BOTH);
  for (const PairClaim& wrong : {too_near, too_far}) {
    EXPECT_EQ(verdict(exact, wrong), Verdict::OURS);
    EXPECT_EQ(verdict(wrong, exact), Verdict::FCL);
    EXPECT_EQ(verdict(wrong, wrong), Verdict::NEITHER);
  }
}

TEST_F(PairOracleTest, BoundsMustHoldTheirOwnDistance) {
  EXPECT_EQ(verdict(PairClaim{2.0, 0.0, 1.0}, exact), Verdict::FCL);
  EXPECT_EQ(verdict(PairClaim{0.0, 1.0, 2.0}, exact), Verdict::FCL);
}

TEST_F(PairOracleTest, UnboundedClaimsAreTrue) {
  EXPECT_EQ(verdict(PairClaim{7.0, -infinity, infinity}, exact), Verdict::BOTH);
}

TEST_F(PairOracleTest, WhoSaysNothingOfAContactIsWrong) {
  EXPECT_EQ(verdict(std::nullopt, exact), Verdict::FCL);
  EXPECT_EQ(verdict(exact, std::nullopt, 1.1), Verdict::OURS);
  EXPECT_EQ(verdict(std::nullopt, std::nullopt, 0.9), Verdict::BOTH);
}

TEST_F(PairOracleTest, FclMayMissWhatItsRoundingHides) {
  EXPECT_EQ(verdict(exact, std::nullopt, 1.0), Verdict::BOTH);
  EXPECT_EQ(verdict(exact, std::nullopt, 1.0 + 16 * ulp), Verdict::BOTH);
  EXPECT_EQ(verdict(exact, std::nullopt, 1.0 + 64 * ulp), Verdict::OURS);
}

// Robust goes by the distance it computes; the others never take a pair for a contact that is none.
TEST_F(PairOracleTest, OnlyRobustMayReportANearMiss) {
  const PairClaim near{below, below, 1.0};
  EXPECT_EQ(verdict(near, std::nullopt, below, Kernel::ROBUST), Verdict::BOTH);
  EXPECT_EQ(verdict(near, std::nullopt, below, Kernel::EXACT), Verdict::FCL);
}

TEST_F(PairOracleTest, NoAnswerIsNeverRight) {
  const FiberAssembly fibers({{0, 0, 0}, {1, 0, 0}, {0, 0, 2}, {1, 0, 2}}, {0, 2, 4}, {0.5});
  QueryOptions options;
  options.margin = 1.0;
  const PairOracle oracle(fibers, options);
  EXPECT_EQ(oracle.judge({0, 2}, exact, std::nullopt, false).verdict, Verdict::OURS);
  EXPECT_EQ(oracle.judge({0, 2}, too_far, std::nullopt, false).verdict, Verdict::NEITHER);
}

}  // namespace
}  // namespace fiber::test
