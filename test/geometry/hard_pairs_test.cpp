// Every kernel on every family of hard pairs, judged in exact rationals.
#include "validation/geometry/hard_pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "test/support/exact_distance.hpp"
#include "test/support/hash.hpp"
#include "test/support/not_finite.hpp"
#include "test/support/public_edge_pairs.hpp"
#include "test/support/random.hpp"

namespace fiber::test {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double least = std::numeric_limits<double>::denorm_min();
constexpr std::uint32_t pairs_per_family = 200;

/// Largest difference of coordinates along one axis.
Rational extent(const HardPair& pair) {
  Rational largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] =
        std::minmax({pair.p0[axis], pair.p1[axis], pair.q0[axis], pair.q1[axis]});
    largest = std::max(largest, Rational(Rational(high) - Rational(low)));
  }
  return largest;
}

Rational truth_squared(const HardPair& pair) {
  return exact_squared_distance(pair.p0, pair.p1, pair.q0, pair.q1);
}

/// low <= √squared <= high, exactly.
bool is_between(const Rational& low, const Rational& squared, const Rational& high) {
  return (low <= 0 || low * low <= squared) && high >= 0 && squared <= high * high;
}

SegmentDistance distance(Kernel kernel, const HardPair& pair) {
  return segment_distance(kernel, pair.p0, pair.p1, pair.q0, pair.q1);
}

/// Exact squared distance of the points that these parameters name.
Rational squared_at(const HardPair& pair, double s, double t) {
  const ExactVector p0 = exact(pair.p0);
  const ExactVector q0 = exact(pair.q0);
  const ExactVector p = add_scaled(p0, s, add_scaled(exact(pair.p1), -1, p0));
  const ExactVector q = add_scaled(q0, t, add_scaled(exact(pair.q1), -1, q0));
  const ExactVector delta = add_scaled(q, -1, p);
  return dot(delta, delta);
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const HardFamily& family : hard_families()) {
    all.push_back(family.name);
  }
  return all;
}

class HardPairs : public testing::TestWithParam<std::string> {
 protected:
  static std::vector<HardPair> pairs() {
    const auto family =
        std::find_if(hard_families().begin(), hard_families().end(),
                     [](const HardFamily& other) { return other.name == GetParam(); });
    return hard_pairs(*family, pairs_per_family, run_seed());
  }
};

TEST_P(HardPairs, RoundedDistancesAreTheExactOnes) {
  SCOPED_TRACE(seed_message());
  for (const HardPair& pair : pairs()) {
    const SegmentDistance robust = distance(Kernel::ROBUST, pair);
    const SegmentDistance exact = distance(Kernel::EXACT, pair);
    const SegmentDistance found =
        rounded_segment_distance(robust, pair.p0, pair.p1, pair.q0, pair.q1);
    ASSERT_EQ(found.distance, exact.distance);
    ASSERT_GE(found.error, exact.error);
    // Whatever the kernel before it took for the nearest points: those are proven, not believed.
    for (const double s : {0.0, 0.5, 1.0}) {
      for (const double t : {0.0, 0.5, 1.0}) {
        SegmentDistance wrong = robust;
        wrong.s = s;
        wrong.t = t;
        const SegmentDistance proven =
            rounded_segment_distance(wrong, pair.p0, pair.p1, pair.q0, pair.q1);
        ASSERT_EQ(proven.distance, exact.distance) << s << ", " << t;
      }
    }
  }
}

TEST_P(HardPairs, BoundsContainTheTruth) {
  SCOPED_TRACE(seed_message());
  for (const HardPair& pair : pairs()) {
    const Rational truth = truth_squared(pair);
    for (const std::string& kernel : kernel_names()) {
      const SegmentDistance found = distance(kernel_from_name(kernel), pair);
      ASSERT_TRUE(std::isfinite(found.distance) && std::isfinite(found.error)) << kernel;
      ASSERT_TRUE(0.0 <= found.lower() && found.lower() <= found.distance &&
                  found.distance <= found.upper())
          << kernel;
      ASSERT_TRUE(is_between(found.lower(), truth, found.upper())) << kernel;
      ASSERT_TRUE(is_between(Rational(found.distance) - Rational(found.error), truth,
                             Rational(found.distance) + Rational(found.error)))
          << kernel;
    }
  }
}

TEST_P(HardPairs, RobustIsWithinFourRoundings) {
  SCOPED_TRACE(seed_message());
  for (const HardPair& pair : pairs()) {
    const SegmentDistance found = distance(Kernel::ROBUST, pair);
    const Rational unit = extent(pair) * Rational(epsilon);
    const Rational allowed = 4 * unit + Rational(least);
    ASSERT_TRUE(is_between(Rational(found.distance) - allowed, truth_squared(pair),
                           Rational(found.distance) + allowed));
    ASSERT_LE(Rational(found.upper()) - Rational(found.lower()), 16 * unit + 4 * Rational(least));
  }
}

TEST_P(HardPairs, ExactIsTheNearestDouble) {
  SCOPED_TRACE(seed_message());
  for (const HardPair& pair : pairs()) {
    const SegmentDistance found = distance(Kernel::EXACT, pair);
    const Rational below = (Rational(found.distance) + std::nextafter(found.distance, 0.0)) / 2;
    const Rational above =
        (Rational(found.distance) + std::nextafter(found.distance, infinity)) / 2;
    ASSERT_TRUE(is_between(below, truth_squared(pair), above)) << found.distance;
    ASSERT_LE(found.error, std::nextafter(found.distance, infinity) - found.distance);
  }
}

TEST_P(HardPairs, ContactsAreDecidedExactly) {
  SCOPED_TRACE(seed_message());
  int in_contact = 0;
  for (const HardPair& pair : pairs()) {
    const auto& [p0, p1, q0, q1, radius_a, radius_b] = pair;
    for (const double margin : {0.0, radius_b * epsilon, -radius_b * epsilon, 0.01 * radius_a}) {
      const Rational sum = Rational(radius_a) + Rational(radius_b) + Rational(margin);
      const Rational truth = truth_squared(pair);
      const bool expected = sum >= 0 && truth <= sum * sum;
      in_contact += expected ? 1 : 0;
      const ContactLimit limit{radius_a, radius_b, margin};
      ASSERT_EQ(exact_gap_at_most(p0, p1, q0, q1, limit), expected);
      ASSERT_EQ(gap_at_most(p0, p1, q0, q1, limit), expected);
    }
  }
  expect_enough(in_contact, 1);
}

/// Limits as near the distance as numbers of twice the digits tell, and nearer.
TEST_P(HardPairs, ContactsAreDecidedExactlyWithinARoundingOfTheLimit) {
  SCOPED_TRACE(seed_message());
  for (const HardPair& pair : pairs()) {
    const auto& [p0, p1, q0, q1, radius_a, radius_b] = pair;
    const Rational truth = truth_squared(pair);
    const Wide distance = sqrt(Wide(numerator(truth)) / Wide(denominator(truth)));
    const double high = std::nextafter(distance.convert_to<double>(), 0.0);
    const double low = std::max(0.0, Wide(distance - high).convert_to<double>());
    for (int exponent = -120; exponent <= -60; exponent += 6) {
      for (const double sign : {-1.0, 1.0}) {
        const ContactLimit limit{high, low, sign * std::ldexp(high, exponent)};
        const Rational sum =
            Rational(limit.radius_a) + Rational(limit.radius_b) + Rational(limit.margin);
        const bool expected = sum >= 0 && truth <= sum * sum;
        ASSERT_EQ(gap_at_most(p0, p1, q0, q1, limit), expected) << exponent;
      }
    }
  }
}

TEST_P(HardPairs, ParametersDeltaAndDistanceAgree) {
  SCOPED_TRACE(seed_message());
  for (const HardPair& pair : pairs()) {
    for (const std::string& kernel : kernel_names()) {
      const SegmentDistance found = distance(kernel_from_name(kernel), pair);
      ASSERT_TRUE(found.s >= 0.0 && found.s <= 1.0 && found.t >= 0.0 && found.t <= 1.0) << kernel;
      const Rational allowed = 8 * Rational(epsilon) * extent(pair) + 4 * Rational(least);
      ASSERT_TRUE(is_between(Rational(found.distance) - allowed, squared_at(pair, found.s, found.t),
                             Rational(found.distance) + allowed))
          << kernel;
      const ExactVector delta = exact(found.delta);
      ASSERT_TRUE(is_between(Rational(found.distance) - allowed, dot(delta, delta),
                             Rational(found.distance) + allowed))
          << kernel;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Families, HardPairs, testing::ValuesIn(names()),
                         [](const auto& instance) { return test_name(instance.param); });

TEST(PublicEdgePairs, EveryKernelAgrees) {
  const std::vector<EdgePair> pairs = public_edge_pairs();
  if (pairs.empty()) {
    GTEST_SKIP() << "no " << public_edge_pairs_path();
  }
  EXPECT_EQ(pairs.size(), 2097U);
  for (const EdgePair& edges : pairs) {
    const HardPair pair{edges.p0, edges.p1, edges.q0, edges.q1, 0.0, 0.0};
    const Rational truth = truth_squared(pair);
    for (const std::string& kernel : kernel_names()) {
      const SegmentDistance found = distance(kernel_from_name(kernel), pair);
      ASSERT_TRUE(is_between(found.lower(), truth, found.upper())) << kernel;
    }
    ASSERT_NEAR(distance(Kernel::ROBUST, pair).distance, edges.distance,
                4 * epsilon * extent(pair).convert_to<double>());
    ASSERT_EQ(distance(Kernel::EXACT, pair).distance, edges.distance);
  }
}

TEST(ExactGap, HasNoLimitWithoutOne) {
  const Eigen::Vector3d p(0, 0, 0);
  const Eigen::Vector3d q(1, 0, 0);
  EXPECT_TRUE(gap_at_most(p, p, q, q, {0.0, 0.0, infinity}));
  EXPECT_TRUE(gap_at_most(p, p, q, q, {0.5, 0.5, 0.0}));
  EXPECT_FALSE(gap_at_most(p, p, q, q, {0.5, 0.5, -least}));
  EXPECT_FALSE(gap_at_most(p, p, p, p, {0.0, 0.0, -least})) << "no gap is below 0 without radii";
}

TEST(HardFamilies, AreTheSameBitsEverywhere) {
  Hash hash;
  for (const HardFamily& family : hard_families()) {
    for (const HardPair& pair : hard_pairs(family, 10, 1)) {
      for (const Eigen::Vector3d& point : {pair.p0, pair.p1, pair.q0, pair.q1}) {
        hash.add(point.x());
        hash.add(point.y());
        hash.add(point.z());
      }
      hash.add(pair.radius_a);
      hash.add(pair.radius_b);
    }
  }
  EXPECT_EQ(hash.value(), 16075505731822437037U);
}

}  // namespace
}  // namespace fiber::test
