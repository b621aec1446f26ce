#include <gtest/gtest.h>

#include <stdexcept>

#include "fiber_proximity/query/crossings.hpp"
#include "src/geometry/gauss_integral.hpp"
#include "test/support/curves.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

Curve moved(const Curve& curve, const Vector3d& by) {
  return mapped(curve, [&](const Vector3d& p) { return Vector3d(p + by); });
}

/// Upright, around the right side of circle(n).
Curve upright_circle(int count) {
  return sampled(count, [](double t) { return Vector3d(1.0 + std::cos(t), 0.0, std::sin(t)); });
}

/// By Gauss's double integral.
double integral(const Curve& a, const Curve& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      sum += gauss_integral(a[i], a[(i + 1) % a.size()], b[j], b[(j + 1) % b.size()]);
    }
  }
  return sum;
}

TEST(LinkingNumber, OfKnownLinks) {
  const Curve ring = circle(30);
  const Curve hopf = upright_circle(30);
  EXPECT_EQ(linking_number(ring, moved(ring, {3, 0, 0})), 0) << "side by side";
  EXPECT_EQ(linking_number(ring, moved(ring, {0, 0, 1})), 0) << "one above the other";
  EXPECT_EQ(std::abs(linking_number(ring, hopf)), 1);
  EXPECT_NEAR(static_cast<double>(linking_number(ring, hopf)), integral(ring, hopf), 1e-12);
  EXPECT_EQ(linking_number(hopf, ring), linking_number(ring, hopf));
  EXPECT_EQ(linking_number(reversed(ring), hopf), -linking_number(ring, hopf));
  EXPECT_EQ(linking_number(reversed(ring), reversed(hopf)), linking_number(ring, hopf));
  EXPECT_EQ(linking_number(mirrored(ring), mirrored(hopf)), -linking_number(ring, hopf));
  EXPECT_EQ(linking_number(whitehead_eight(), circle(24, 1.3)), 0);
  for (const int n : {1, 2, 3, 7, -2}) {
    const Curve a = torus_link(40 * std::abs(n), n, false);
    const Curve b = torus_link(40 * std::abs(n), n, true);
    EXPECT_EQ(linking_number(a, b), n) << "T(2, " << 2 * n << ")";
  }
}

TEST(LinkingNumber, IsGausssIntegralForRandomLinksSeenFromAnywhere) {
  SCOPED_TRACE(seed_message());
  Random random(11);
  int linked = 0;
  for (int round = 0; round < 100; ++round) {
    const Curve a = random_curve(random, random.integer(3, 20));
    const Curve b = random_curve(random, random.integer(3, 20));
    const std::int64_t number = linking_number(a, b);
    EXPECT_NEAR(static_cast<double>(number), integral(a, b), 1e-9);
    for (int i = 0; i < 5; ++i) {
      // As good as another direction of view.
      const Eigen::AngleAxisd rotation(random.uniform(0.0, 3.0), random.direction());
      const auto rotate = [&](const Vector3d& p) { return Vector3d(rotation * p); };
      EXPECT_EQ(linking_number(mapped(a, rotate), mapped(b, rotate)), number);
    }
    linked += number != 0 ? 1 : 0;
  }
  expect_enough(linked, 11);
}

// A chain of rings; the last fibre is closed already.
TEST(LinkingNumber, OfAllPairsOfFibres) {
  const std::vector<LinkingNumber> numbers = linking_numbers(
      as_fibers({circle(20), upright_circle(20), moved(circle(20), {2, 0, 0}),
                 moved(circle(20), {0, 0, 9}), closed(moved(upright_circle(20), {2, 0, 0}))}));
  ASSERT_EQ(numbers.size(), 3U);
  EXPECT_EQ(numbers[0].fiber_a, 0U);
  EXPECT_EQ(numbers[0].fiber_b, 1U);
  EXPECT_EQ(numbers[1].fiber_a, 1U);
  EXPECT_EQ(numbers[1].fiber_b, 2U);
  EXPECT_EQ(numbers[2].fiber_a, 2U);
  EXPECT_EQ(numbers[2].fiber_b, 4U);
  EXPECT_EQ(numbers[0].value, numbers[2].value);
  EXPECT_EQ(numbers[0].value, -numbers[1].value);
  EXPECT_TRUE(linking_numbers(FiberAssembly()).empty());
}

TEST(LinkingNumber, DoesNotDependOnPlaceOrScale) {
  for (const double scale : {1e-150, 1e-3, 1e140}) {
    for (const double offset : {0.0, 1e6}) {
      const auto map = [&](const Vector3d& p) {
        return Vector3d(scale * (p + offset * Vector3d(1, -2, 3)));
      };
      EXPECT_EQ(linking_number(mapped(torus_link(50, 3, false), map),
                               mapped(torus_link(50, 3, true), map)),
                3)
          << scale << " " << offset;
    }
  }
}

TEST(LinkingNumber, RefusesWhatIsNoCurve) {
  EXPECT_THROW(linking_number({}, circle(5)), std::invalid_argument);
  EXPECT_THROW(linking_number(circle(5), {{0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(linking_number(circle(5), {{0, 0, 0}, {std::nan(""), 0, 0}}), std::invalid_argument);
}

}  // namespace
}  // namespace fiber::test
