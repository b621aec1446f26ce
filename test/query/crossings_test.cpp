#include "fiber_proximity/query/crossings.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "test/query/crossing_views.hpp"
#include "test/support/curves.hpp"
#include "test/support/error_of.hpp"
#include "test/support/exact_crossings.hpp"
#include "test/support/not_finite.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

double to_double(const Rational& value) { return value.convert_to<double>(); }

// Over the second segment of a goes b, up along y, seen from above.
TEST(Crossings, OfTwoFibresSeenFromAboveAndBelow) {
  const FiberAssembly fibers =
      as_fibers({{{-2, 0, 0}, {-1, 0, 0}, {1, 0, 0}}, {{0.5, -1, 0.5}, {0.5, 3, 0.5}}}, 0.1);
  const std::vector<Crossing> above = find_crossings(fibers, View());
  ASSERT_EQ(above.size(), 1U);
  const Crossing& crossing = above[0];
  EXPECT_EQ(crossing.key(), std::make_tuple(0U, 1U, 1U, 0U));
  EXPECT_EQ(crossing.s, 0.75);
  EXPECT_EQ(crossing.t, 0.25);
  EXPECT_FALSE(crossing.a_is_over);
  EXPECT_EQ(crossing.sign, -1);  // from y, above, to x it is a quarter turn clockwise
  EXPECT_EQ(crossing.separation, 0.5);
  EXPECT_EQ(crossing.gap, 0.5 - 0.2);
  EXPECT_EQ(crossing.point_a, Vector3d(0.5, 0, 0));
  EXPECT_EQ(crossing.point_b, Vector3d(0.5, 0, 0.5));
  const std::vector<Crossing> below = find_crossings(fibers, along({0, 0, 1}));
  ASSERT_EQ(below.size(), 1U);
  EXPECT_TRUE(below[0].a_is_over);
  EXPECT_EQ(below[0].sign, -1);
}

/// What is joined does not cross where it is, nor if the joint's points are a little apart; a fibre
/// that is seen to pass through a joint crosses one of its segments.
TEST(Crossings, JointsAreNone) {
  for (const double apart : {0.0, 0.05}) {
    const std::vector<Vector3d> points{
        {-1, 0, 0},  {0, 0, 0},     {1, 0, 0},  {-apart, 0, 0.1 * apart},
        {0.2, 1, 0}, {-0.5, -1, 1}, {0.5, 1, 1}};
    const std::vector<std::uint32_t> offsets{0, 3, 5, 7};
    const auto count = [&](const FiberTopology& topology) {
      std::size_t own = 0;
      std::size_t others = 0;
      for (const Crossing& crossing :
           find_crossings(FiberAssembly(points, offsets, {0.1}, topology), View())) {
        (crossing.fiber_b == 2 ? others : own) += 1;
      }
      return std::make_pair(own, others);
    };
    const auto joined = count({{}, {-1, 4, -1, 4, -1, -1, -1}, {}});
    EXPECT_EQ(joined.first, 0U) << apart;
    EXPECT_GE(joined.second, 1U);
  }
}

TEST(Crossings, OfAClosedFiberAreThoseOfItsRepeatedPoints) {
  Curve curve = trefoil(30);
  const FiberAssembly closed(curve, {0, 30}, {0.1}, {{1}, {}, {}});
  EXPECT_EQ(find_crossings(closed, View()).size(), 3U);
  curve.push_back(curve.front());
  EXPECT_EQ(find_crossings(closed, View()).size(),
            find_crossings(FiberAssembly(curve, {0, 31}, {0.1}), View()).size());
  const std::vector<Vector3d> stored = closed.points();
  EXPECT_EQ(writhe(stored), writhe(curve));
  Curve two = circle(30);
  for (const Vector3d& point : circle(30)) {
    two.emplace_back(1.0 + point.x(), 0.0, point.y());
  }
  const std::vector<LinkingNumber> linked =
      linking_numbers(FiberAssembly(two, {0, 30, 60}, {0.1}, {{1, 1}, {}, {}}));
  ASSERT_EQ(linked.size(), 1U);
  EXPECT_EQ(std::abs(linked[0].value), 1);
}

TEST(Crossings, SeenFromAnEyeAreThoseInFrontOfIt) {
  const FiberAssembly fibers =
      as_fibers({{{-2, 0, 0}, {2, 0, 0}}, {{0.5, -1, 0.5}, {0.5, 3, 0.5}}});
  const std::vector<Crossing> seen = find_crossings(fibers, from({0.5, 0, 1}, {0, 0, -1}));
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_FALSE(seen[0].a_is_over);
  EXPECT_EQ(seen[0].sign, -1);
  EXPECT_EQ(seen[0].s, 0.625);
  EXPECT_EQ(seen[0].separation, 0.5);
  EXPECT_EQ(find_crossings(fibers, from({0.5, 0, 1}, {0, 0, 1})).size(), 0U) << "behind";
  EXPECT_EQ(find_crossings(fibers, from({0.5, 0, 0.25}, {0, 0, -1})).size(), 0U) << "between";
  EXPECT_EQ(find_crossings(fibers, from({0.5, 0, 0.5}, {0, 0, -1})).size(), 0U) << "in the axis";
  EXPECT_EQ(find_crossings(fibers, from({9, 9, 1}, {0, 0, -1})).size(), 0U) << "from aside";
}

// One end of each is behind the eye: in front of it they cross, or they do behind it.
TEST(Crossings, OfSegmentsThatPassTheEye) {
  const FiberAssembly fibers = as_fibers({{{-1, 1, -1}, {3, 1, 3}}, {{3, 2, -1}, {-1, 2, 3}}});
  const std::vector<Crossing> seen = find_crossings(fibers, from({1, 0, 0}, {0, 0, 1}));
  EXPECT_EQ(seen.size(), exact_crossings(fibers, from({1, 0, 0}, {0, 0, 1})).size());
  const std::vector<Crossing> front = find_crossings(fibers, from({1, -5, 1}, {0, 1, 1}));
  ASSERT_EQ(front.size(), 1U);
  EXPECT_TRUE(front[0].a_is_over);
  EXPECT_EQ(find_crossings(fibers, from({1, -5, 1}, {0, -1, 0})).size(), 0U);
}

TEST(Crossings, OfKnownKnots) {
  const auto count_and_sum = [](const Curve& curve) {
    const std::vector<Crossing> crossings =
        find_crossings(as_fibers({closed(curve)}), along({1e-3, 2e-3, -1}));
    return std::make_pair(static_cast<int>(crossings.size()), sum_of_signs(crossings));
  };
  const Curve unknot_with_twist =
      sampled(60, [](double t) { return Vector3d(std::sin(t), std::sin(2.0 * t), std::cos(t)); });
  EXPECT_EQ(count_and_sum(circle(60)), std::make_pair(0, 0));
  EXPECT_EQ(count_and_sum(unknot_with_twist).first, 1);
  EXPECT_EQ(count_and_sum(trefoil(60)), std::make_pair(3, -3));
  EXPECT_EQ(count_and_sum(mirrored(trefoil(60))), std::make_pair(3, 3));
  EXPECT_EQ(count_and_sum(reversed(trefoil(60))), std::make_pair(3, -3));
  EXPECT_EQ(count_and_sum(figure_eight(90)), std::make_pair(4, 0));
  EXPECT_EQ(count_and_sum(whitehead_eight()).first, 1);
}

// Walking along the trefoil and the figure-eight knot one goes over and under in turn.
TEST(Crossings, OfAlternatingKnotsAlternate) {
  for (const Curve& curve : {trefoil(60), figure_eight(90)}) {
    const std::vector<Crossing> crossings =
        find_crossings(as_fibers({closed(curve)}), along({0, 0, -1}));
    std::vector<std::pair<double, bool>> passes;
    for (const Crossing& crossing : crossings) {
      passes.emplace_back(crossing.segment_a + crossing.s, crossing.a_is_over);
      passes.emplace_back(crossing.segment_b + crossing.t, !crossing.a_is_over);
    }
    std::sort(passes.begin(), passes.end());
    for (std::size_t i = 1; i < passes.size(); ++i) {
      EXPECT_NE(passes[i].second, passes[i - 1].second) << "pass " << i;
    }
  }
}

void expect_exact(const FiberAssembly& fibers, const View& view) {
  const std::vector<Crossing> found = find_crossings(fibers, view);
  const std::vector<ExactCrossing> expected = exact_crossings(fibers, view);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(Key(found[i].key()), expected[i].key);
    EXPECT_NEAR(found[i].s, to_double(expected[i].s), 0x1p-38);
    EXPECT_NEAR(found[i].t, to_double(expected[i].t), 0x1p-38);
    EXPECT_EQ(found[i].a_is_over, expected[i].a_is_over);
    EXPECT_EQ(found[i].sign, expected[i].sign);
  }
}

TEST(Crossings, AreThoseOfRationalsForRandomFibres) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  for (int round = 0; round < 60; ++round) {
    const FiberAssembly fibers =
        as_fibers({random_curve(random, 12), random_curve(random, 9), random_curve(random, 2)});
    expect_exact(fibers, random_view(random));
  }
}

// At 1e6 m the doubles of a fibre are 1e-10 m apart; nearly parallel ones cross at small angles.
TEST(Crossings, AreThoseOfRationalsFarAwayTinyAndNearlyParallel) {
  SCOPED_TRACE(seed_message());
  Random random(2);
  for (int round = 0; round < 30; ++round) {
    for (const double scale : {1e-3, 1e-5, 1e-100, 1e-310, 1e100}) {
      const Vector3d middle =
          scale > 1e-10 && scale < 1.0 ? Vector3d(1e6 * random.direction()) : Vector3d::Zero();
      const auto place = [&](const Curve& curve) {
        return mapped(curve, [&](const Vector3d& p) { return Vector3d(middle + scale * p); });
      };
      const FiberAssembly fibers =
          as_fibers({place(random_curve(random, 8)), place(random_curve(random, 8))});
      SCOPED_TRACE("scale " + std::to_string(std::log10(scale)));
      expect_exact(fibers, random_view(random, middle, scale));
    }
    std::vector<Curve> parallel;
    const Vector3d u = random.direction();
    for (int i = 0; i < 6; ++i) {
      parallel.push_back({-u + 1e-13 * random.in_cube(), u + 1e-13 * random.in_cube()});
    }
    expect_exact(as_fibers(parallel), random_view(random, {0, 0, 0}, 10.0));
  }
}

TEST(Crossings, MirrorReversalAndRotation) {
  SCOPED_TRACE(seed_message());
  Random random(7);
  for (int round = 0; round < 20; ++round) {
    const Curve a = random_curve(random, 15);
    const Curve b = random_curve(random, 10);
    const std::vector<Crossing> original = find_crossings(as_fibers({a, b}), View());
    const std::vector<Crossing> mirror =
        find_crossings(as_fibers({mirrored(a), mirrored(b)}), View());
    const Eigen::Quaterniond rotation = random.rotation();
    const auto rotate = [&](const Vector3d& p) { return Vector3d(rotation * p); };
    const std::vector<Crossing> rotated = find_crossings(
        as_fibers({mapped(a, rotate), mapped(b, rotate)}), along(rotate({0, 0, -1})));
    ASSERT_EQ(mirror.size(), original.size());
    ASSERT_EQ(rotated.size(), original.size());
    for (std::size_t i = 0; i < original.size(); ++i) {
      EXPECT_EQ(mirror[i].sign, -original[i].sign);
      EXPECT_NE(mirror[i].a_is_over, original[i].a_is_over);
      EXPECT_EQ(mirror[i].s, original[i].s);
      EXPECT_EQ(rotated[i].key(), original[i].key());
      EXPECT_EQ(rotated[i].sign, original[i].sign);
      EXPECT_EQ(rotated[i].a_is_over, original[i].a_is_over);
      EXPECT_NEAR(rotated[i].separation, original[i].separation, 1e-9);
    }
    const auto signs_between = [](const std::vector<Crossing>& crossings) {
      int sum = 0;
      for (const Crossing& crossing : crossings) {
        sum += crossing.fiber_a != crossing.fiber_b ? crossing.sign : 0;
      }
      return sum;
    };
    EXPECT_EQ(sum_of_signs(find_crossings(as_fibers({reversed(a), reversed(b)}), View())),
              sum_of_signs(original));
    EXPECT_EQ(signs_between(find_crossings(as_fibers({reversed(a), b}), View())),
              -signs_between(original));
  }
}

TEST(Crossings, AreTheSameForAnyNumberOfThreadsAndInUsedMemory) {
  SCOPED_TRACE(seed_message());
  Random random(8);
  CrossingFinder one(1);
  CrossingFinder two(2);
  for (const int count : {200, 300, 50}) {
    const FiberAssembly fibers = as_fibers({random_curve(random, count)});
    const View view = random_view(random);
    std::vector<Crossing> first(3);
    std::vector<Crossing> second;
    one.find(fibers, view, first);
    two.find(fibers, view, second);
    ASSERT_EQ(first.size(), second.size());
    EXPECT_EQ(keys_of(first), keys_of(second));
    EXPECT_EQ(keys_of(first), keys_of(find_crossings(fibers, view)));
    for (std::size_t i = 0; i < first.size(); ++i) {
      EXPECT_EQ(first[i].s, second[i].s);
      EXPECT_EQ(first[i].separation, second[i].separation);
    }
  }
}

TEST(Crossings, RefuseViewsThatAreNone) {
  const auto refusal = [](const View& view) {
    return error_of([&] { find_crossings(FiberAssembly(), view); });
  };
  const std::string rule = ", coordinates must be finite and at most 1e150 m in magnitude";
  EXPECT_EQ(refusal(along({0, 0, 0})), "direction of view: is 0,0,0, it must have a length");
  EXPECT_EQ(refusal(along({0, std::nan(""), 0})), "direction of view: y is nan" + rule);
  EXPECT_EQ(refusal(from({-infinity, 0, 0}, {1, 0, 0})), "eye: x is -inf" + rule);
  EXPECT_EQ(refusal(from({0, 0, 1e151}, {1, 0, 0})), "eye: z is 1e+151" + rule);
  EXPECT_EQ(refusal(along({0, 0, 1e-320})), "no error");
}

}  // namespace
}  // namespace fiber::test
