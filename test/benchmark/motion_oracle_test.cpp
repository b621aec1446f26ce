// Tests of the oracle that judges answers about motions.
#include "validation/geometry/motion_oracle.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "test/support/random.hpp"
#include "test/support/rounds.hpp"
#include "validation/geometry/motion_separation.hpp"
#include "validation/geometry/time_polynomial.hpp"

namespace fiber::test {
namespace {

using Verdict = MotionOracle::Verdict;

QuadNumber value_at(const TimePolynomial& polynomial, double time) {
  QuadNumber value = 0;
  for (std::size_t i = polynomial.coefficients.size(); i > 0; --i) {
    value = value * time + polynomial.coefficients[i - 1];
  }
  return value;
}

TEST(TimePolynomial, IsPositiveOnlyWhereAllItsValuesAre) {
  SCOPED_TRACE(seed_message());
  Random random;
  int positive = 0;
  for (int round = 0; round < rounds(5000); ++round) {
    std::vector<QuadNumber> coefficients(static_cast<std::size_t>(random.integer(1, 7)));
    for (QuadNumber& coefficient : coefficients) {
      coefficient = random.uniform(-1.0, 1.0);
    }
    const TimePolynomial polynomial(coefficients, 7);
    const double begin = random.uniform(0.0, 1.0);
    const double end = random.uniform(begin, 1.0);
    if (polynomial.is_positive(begin, end)) {
      ++positive;
      for (int i = 0; i <= 20; ++i) {
        ASSERT_GT(value_at(polynomial, begin + (end - begin) * i / 20.0), 0) << round;
      }
    }
  }
  expect_enough(positive, rounds(1000));
}

TEST(TimePolynomial, IsFollowedToAnyPowerOfTime) {
  // 4 (t − 1/2)² + 2⁻⁴⁰, whose least value is far below its coefficients.
  const TimePolynomial polynomial({1.0 + 0x1p-40, -4.0, 4.0}, 9);
  EXPECT_FALSE(polynomial.is_positive(0.0, 1.0)) << "coefficients in the basis are below it";
  EXPECT_TRUE(polynomial.is_positive(0.5 - 0x1p-22, 0.5 + 0x1p-22));
  const TimePolynomial zero({0.25, -1.0, 1.0}, 3);
  EXPECT_FALSE(zero.is_positive(0.5 - 0x1p-30, 0.5 + 0x1p-30));
}

/// Two segments of one metre at right angles, 1 m apart, of which the upper one comes down by a way
/// and turns.
HardMotion descending(double way, double turn) {
  HardMotion motion;
  const Eigen::Vector3d half(0.5, 0.0, 0.0);
  const Eigen::Vector3d half_after(0.5 * std::cos(turn), 0.5 * std::sin(turn), 0.0);
  const Eigen::Vector3d before(0.0, 0.0, 1.0);
  const Eigen::Vector3d after(0.0, 0.0, 1.0 - way);
  motion.a_before = {before - half, before + half};
  motion.a_after = {after - half_after, after + half_after};
  motion.b_before =
      motion.b_after = {Eigen::Vector3d(0.0, -0.5, 0.0), Eigen::Vector3d(0.0, 0.5, 0.0)};
  motion.radius_a = 0.1;
  return motion;
}

TEST(MotionSeparation, HoldsUpToAContactAndNotAcross) {
  for (const double turn : {0.0, 0.3, -1.0}) {
    const HardMotion motion = descending(1.0, turn);  // touches at 0.9
    const MotionSeparation separation(motion);
    EXPECT_TRUE(separation.holds_between(0.85L, 0.9L - 1e-12L));
    EXPECT_FALSE(separation.holds_between(0.85L, 0.9L + 1e-12L));
    EXPECT_FALSE(separation.holds_between(0.95L, 1.0L));
    EXPECT_TRUE(MotionSeparation(descending(0.9 - 1e-12, turn)).holds_between(0.9L, 1.0L));
  }
}

/// Against distances at times in the piece.
TEST(MotionSeparation, NeverHoldsWhereThereIsContact) {
  SCOPED_TRACE(seed_message());
  int separated = 0;
  int touching = 0;
  for (const MotionFamily& family : motion_families()) {
    SCOPED_TRACE(family.name);
    Random random;
    for (const HardMotion& motion :
         hard_motions(family, static_cast<std::uint32_t>(rounds(100)), run_seed())) {
      const double begin = random.uniform(0.0, 1.0);
      const double end = random.uniform(begin, 1.0);
      const bool holds = MotionSeparation(motion).holds_between(begin, end);
      const MotionOracle oracle(motion);
      bool touches = false;
      for (int i = 0; i <= 10; ++i) {
        touches = touches || oracle.is_within(begin + (end - begin) * i / 10.0, 0.0);
      }
      ASSERT_FALSE(holds && touches) << begin << " to " << end;
      separated += holds ? 1 : 0;
      touching += touches ? 1 : 0;
    }
  }
  expect_enough(separated, rounds(500));
  expect_enough(touching, rounds(150));
}

TEST(MotionOracle, TellsContactsThatAreHardToTell) {
  for (const double turn : {0.0, 0.3, -1.0}) {
    for (double depth = 1e-3; depth > 1e-14; depth *= 0.1) {
      EXPECT_EQ(MotionOracle(descending(0.9 - depth, turn)).contact_before(1.0), Verdict::NONE);
      EXPECT_EQ(MotionOracle(descending(0.9 + depth, turn)).contact_before(1.0), Verdict::CONTACT);
    }
  }
}

}  // namespace
}  // namespace fiber::test
