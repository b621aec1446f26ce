#include "fiber_proximity/query/for_engines/loop_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "test/support/cables.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// The rule as it is stated, point by point, in twice a double's digits where the machine has them.
class Rule {
 public:
  explicit Rule(const FiberAssembly& fibers) : fibers_(fibers) {}

  bool makes_loop(PointPair pair, const SegmentDistance& nearest, double factor = 1.0) const {
    const std::vector<Vector3d>& p = fibers_.points();
    const double radius = std::max(fibers_.segment_radius(pair.a), fibers_.segment_radius(pair.b));
    const auto at = [&](std::uint32_t i, double s) -> Long {
      return (1.0L - s) * p[i].cast<long double>() + s * p[i + 1].cast<long double>();
    };
    const auto leaves = [&](const Long& x, const Long& y) {
      const long double limit = factor * (1.25L * (x - y).norm() + 2.5L * radius);
      for (std::uint32_t k = pair.a + 1; k <= pair.b; ++k) {
        const Long point = p[k].cast<long double>();
        if (std::max((point - x).norm(), (point - y).norm()) > limit) {
          return true;
        }
      }
      return false;
    };
    if (leaves(at(pair.a, nearest.s), at(pair.b, nearest.t))) {
      return true;
    }
    const long double most = factor * (nearest.distance + radius);
    const SegmentDistance of_a = segment_distance(p[pair.a], p[pair.a], p[pair.b], p[pair.b + 1]);
    const SegmentDistance of_b =
        segment_distance(p[pair.a], p[pair.a + 1], p[pair.b + 1], p[pair.b + 1]);
    return (of_a.distance <= most && leaves(at(pair.a, 0.0), at(pair.b, of_a.t))) ||
           (of_b.distance <= most && leaves(at(pair.a, of_b.s), at(pair.b, 1.0)));
  }

 private:
  using Long = Eigen::Matrix<long double, 3, 1>;
  const FiberAssembly& fibers_;
};

/// A random walk: with bends, loops and knots of every size, and radii that change.
FiberAssembly random_cable(Random& random, int count) {
  Curve points;
  std::vector<double> radii;
  Vector3d place = Vector3d::Zero();
  Vector3d direction = random.direction();
  const double step = std::exp(random.uniform(-3.0, 2.0));
  const double stiffness = random.uniform(0.0, 8.0);
  for (int i = 0; i < count; ++i) {
    points.push_back(place);
    radii.push_back(random.chance(0.1) ? 0.0 : random.uniform(0.5, 1.0));
    direction = (stiffness * direction + random.direction()).normalized();
    place += step * direction;
  }
  const double scale = std::exp(random.uniform(-5.0, 5.0));
  for (int i = 0; i < count; ++i) {
    points[i] *= scale;
    radii[i] *= scale;
  }
  return {points, {0, static_cast<std::uint32_t>(count)}, radii};
}

TEST(LoopTest, DecidesByTheRule) {
  SCOPED_TRACE(seed_message());
  Random random;
  int loops = 0;
  int others = 0;
  for (int round = 0; round < rounds(60); ++round) {
    const FiberAssembly fibers = random_cable(random, random.integer(4, 150));
    const LoopTest test(fibers);
    const Rule rule(fibers);
    const auto last = static_cast<std::uint32_t>(fibers.segment_count()) - 1;
    for (std::uint32_t i = 0; i < last; ++i) {
      for (std::uint32_t j = i + 2; j <= last; ++j) {
        const std::vector<Vector3d>& p = fibers.points();
        const SegmentDistance nearest = segment_distance(p[i], p[i + 1], p[j], p[j + 1]);
        const bool found = test.makes_loop({i, j}, nearest);
        (found ? loops : others) += 1;
        ASSERT_TRUE(test.are_of_one_fiber({i, j}));
        // Rounding may decide within a billionth.
        ASSERT_TRUE(found == rule.makes_loop({i, j}, nearest, 1.0 + 1e-9) ||
                    found == rule.makes_loop({i, j}, nearest, 1.0 - 1e-9))
            << "segments " << i << " and " << j << " of " << last + 1;
        ASSERT_FALSE(found && test.rules_out(i, j));
      }
    }
  }
  expect_enough(loops, 1000);
  expect_enough(others, 1000);
}

/// What is ruled out at once is ruled out pair by pair, by the rule itself.
TEST(LoopTest, HoldsToItsRuleWhereAFiberStaysNearOnePlaceForLong) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < 4; ++round) {
    std::vector<Vector3d> points;
    for (int i = 0; i < 700; ++i) {
      points.push_back(random.in_cube());
    }
    // Between what all points are within of all, and what none is.
    const double radius = random.uniform(0.4, 1.4);
    const FiberAssembly fibers(points, {0, 700}, {radius});
    const LoopTest test(fibers);
    const Rule rule(fibers);
    for (std::uint32_t i = 0; i + 2 < 699; i += 7) {
      for (std::uint32_t j = i + 2; j < 699; j += 5) {
        const SegmentDistance nearest =
            segment_distance(points[i], points[i + 1], points[j], points[j + 1]);
        const bool found = test.makes_loop({i, j}, nearest);
        ASSERT_TRUE(found == rule.makes_loop({i, j}, nearest, 1.0 + 1e-9) ||
                    found == rule.makes_loop({i, j}, nearest, 1.0 - 1e-9))
            << i << ", " << j << ", radius " << radius;
      }
    }
  }
}

TEST(LoopTest, RulesOutOnlyWhatHasNoLoop) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::size_t ruled_out = 0;
  for (int round = 0; round < rounds(30); ++round) {
    for (const Cable& cable :
         loopless_cables(random.integer(4, 120), std::exp(random.uniform(0.0, 7.0)), random)) {
      const FiberAssembly fibers = cable.fibers(std::exp(random.uniform(-5.0, 5.0)));
      const LoopTest test(fibers);
      const Rule rule(fibers);
      for (std::uint32_t i = 0; i < fibers.segment_count(); ++i) {
        const PointRange with_i = test.ruled_out_with(i);
        for (std::uint32_t j = i + 2; j < fibers.segment_count(); ++j) {
          const PointRange with_j = test.ruled_out_with(j);
          ASSERT_EQ(with_i.begin <= j && j < with_i.end, test.rules_out(i, j)) << i << ", " << j;
          ASSERT_EQ(with_j.begin <= i && i < with_j.end, test.rules_out(i, j)) << i << ", " << j;
          if (test.rules_out(i, j)) {
            ++ruled_out;
            const std::vector<Vector3d>& p = fibers.points();
            ASSERT_FALSE(rule.makes_loop({i, j}, segment_distance(p[i], p[i + 1], p[j], p[j + 1])))
                << cable.name << ", segments " << i << " and " << j;
          }
        }
      }
    }
  }
  EXPECT_GT(ruled_out, 1000U);
}

TEST(LoopTest, AThickEndHidesNoLoopOfThinSegments) {
  Curve points;
  std::vector<double> radii;
  for (int i = 0; i < 50; ++i) {  // one turn and a quarter, then straight on
    const double angle = 0.2 * std::min(i, 40);
    points.emplace_back(0.5 * std::cos(angle), 0.5 * std::sin(angle), 0.01 * i);
    radii.push_back(i < 48 ? 0.1 : 2.0);
  }
  const FiberAssembly fibers(points, {0, 50}, radii);
  const LoopTest test(fibers);
  const Rule rule(fibers);
  int loops = 0;
  for (std::uint32_t i = 0; i < 40; ++i) {
    for (std::uint32_t j = i + 2; j < 40; ++j) {
      const bool is_loop = rule.makes_loop(
          {i, j}, segment_distance(points[i], points[i + 1], points[j], points[j + 1]));
      ASSERT_FALSE(is_loop && test.rules_out(i, j)) << "segments " << i << " and " << j;
      loops += is_loop ? 1 : 0;
    }
  }
  EXPECT_GT(loops, 0);
}

TEST(LoopTest, RulesOutAllOfAStraightNoisyCableAtOnce) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const double length : {100.0, 2000.0, 20000.0}) {
    for (const Cable& cable : loopless_cables(2000, length, random)) {
      if (cable.name.find("straight") == std::string::npos) {
        continue;
      }
      const FiberAssembly fibers = cable.fibers();
      EXPECT_TRUE(LoopTest(fibers).rules_out(0, 1998)) << cable.name;
    }
  }
}

TEST(LoopTest, DoesNotDependOnSizeOrPlaceNorOnTheDirectionOfPoints) {
  for (const Cable& cable : {hairpin(7.0, 11), coil(2.6, 3.0, 7), tight_knot(30)}) {
    SCOPED_TRACE(cable.name);
    const FiberAssembly fibers = cable.fibers();
    Cable reversed = cable;
    std::reverse(reversed.points.begin(), reversed.points.end());
    const auto last = static_cast<std::uint32_t>(fibers.segment_count()) - 1;
    const auto makes_loop = [](const FiberAssembly& of, std::uint32_t i, std::uint32_t j) {
      const std::vector<Vector3d>& p = of.points();
      return LoopTest(of).makes_loop({i, j}, segment_distance(p[i], p[i + 1], p[j], p[j + 1]));
    };
    for (std::uint32_t i = 0; i < last; ++i) {
      for (std::uint32_t j = i + 2; j <= last; ++j) {
        const bool expected = makes_loop(fibers, i, j);
        // Powers of two: nothing is rounded on the way.
        for (const double scale : {0x1p-1000, 0x1p-600, 0x1p-300, 0x1p-30, 0x1p40, 0x1p490}) {
          ASSERT_EQ(makes_loop(cable.fibers(scale), i, j), expected) << scale;
        }
        ASSERT_EQ(makes_loop(reversed.fibers(), last - j, last - i), expected);
      }
    }
  }
}

TEST(LoopTest, TellsFibersApart) {
  const FiberAssembly fibers({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}},
                             {0, 4, 6}, {0.1});
  const LoopTest test(fibers);
  EXPECT_TRUE(test.are_of_one_fiber({0, 2}));
  EXPECT_FALSE(test.are_of_one_fiber({0, 4}));
  EXPECT_FALSE(test.are_of_one_fiber({2, 4}));
  EXPECT_TRUE(test.rules_out(0, 2));
  EXPECT_FALSE(test.rules_out(0, 4));
}

}  // namespace
}  // namespace fiber::test
