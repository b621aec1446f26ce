#include "fiber_proximity/query/crossings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "test/support/assemblies.hpp"
#include "test/support/curves.hpp"
#include "test/support/exact_crossings.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

View along(const Vector3d& direction) {
  View view;
  view.direction = direction;
  return view;
}

View from(const Vector3d& eye, const Vector3d& direction) {
  View view;
  view.direction = direction;
  view.is_perspective = true;
  view.eye = eye;
  return view;
}

int sum_of_signs(const std::vector<Crossing>& crossings) {
  int sum = 0;
  for (const Crossing& crossing : crossings) {
    sum += crossing.sign;
  }
  return sum;
}

/// Either kind of view, of fibres around a point.
View random_view(Random& random, const Vector3d& middle = Vector3d::Zero(), double size = 1.0) {
  return random.chance(0.5) ? along(random.uniform(0.1, 10.0) * random.direction())
                            : from(middle + size * random.in_cube(2.0), random.direction());
}

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

/// Each pair of segments of open fibres as an assembly of its own, in which it is perturbed as in
/// the whole one: no candidates to lose.
std::vector<Key> crossings_of_pairs(const FiberAssembly& fibers, const View& view) {
  std::vector<Key> keys;
  // Whether all points from i to j are one.
  const auto together = [&](std::uint32_t i, std::uint32_t j) {
    for (; i < j; ++i) {
      if (fibers.points()[i] != fibers.points()[i + 1]) {
        return false;
      }
    }
    return true;
  };
  for (const std::uint32_t a : segments_of(fibers)) {
    for (const std::uint32_t b : segments_of(fibers)) {
      const SegmentId id_a = fibers.segment_id(a);
      const SegmentId id_b = fibers.segment_id(b);
      const bool neighbours = id_a.fiber == id_b.fiber && together(a + 1, b);
      if (a >= b || neighbours) {
        continue;
      }
      const Capsule p = fibers.capsule(a);
      const Capsule q = fibers.capsule(b);
      if (!find_crossings(as_fibers({{p.p0, p.p1}, {q.p0, q.p1}}), view).empty()) {
        keys.emplace_back(id_a.fiber, id_a.segment, id_b.fiber, id_b.segment);
      }
    }
  }
  return keys;
}

std::vector<Key> keys_of(const std::vector<Crossing>& crossings) {
  std::vector<Key> keys;
  for (const Crossing& crossing : crossings) {
    keys.emplace_back(crossing.key());
  }
  return keys;
}

TEST(Crossings, OfEveryFamilyAreThoseOfAllPairs) {
  SCOPED_TRACE(seed_message());
  Random random(3);
  for (const AssemblyFamily& family : assembly_families()) {
    SCOPED_TRACE(family.name);
    const FiberAssembly fibers = family.make(random);
    const Vector3d middle = fibers.points().empty() ? Vector3d::Zero() : fibers.points().front();
    const double size = fibers.points().empty() ? 1.0 : (fibers.points().back() - middle).norm();
    for (const View& view : {View(), along({1, 0, 0}), random_view(random, middle, size)}) {
      EXPECT_EQ(keys_of(find_crossings(fibers, view)), crossings_of_pairs(fibers, view));
    }
  }
}

/// Its ends differ.
Curve open_grid_curve(Random& random, int count, int half_edge) {
  Curve curve = grid_curve(random, count, half_edge);
  while (curve.front() == curve.back()) {
    curve = grid_curve(random, count, half_edge);
  }
  return curve;
}

/// Directions along which the points of a grid hide each other, and eyes among them.
std::vector<View> grid_views() {
  std::vector<View> views{along({0, 0, -1}), along({0, 0, 1}),    along({1, 0, 0}),
                          along({0, -1, 0}), along({1, 1, 0}),    along({1, -1, 1}),
                          along({2, 1, 0}),  along({0.3, 0.5, 1})};
  for (const Vector3d& eye : {Vector3d(0, 0, -9), Vector3d(5, 5, -9), Vector3d(0.1, 0.2, -9)}) {
    views.push_back(from(eye, {0, 0, 1}));
  }
  return views;
}

TEST(Crossings, OnAGridAreThoseOfAllPairs) {
  SCOPED_TRACE(seed_message());
  Random random(4);
  for (int round = 0; round < 8; ++round) {
    const FiberAssembly fibers =
        as_fibers({open_grid_curve(random, 9, 1), open_grid_curve(random, 7, 1)});
    for (View view : grid_views()) {
      EXPECT_EQ(keys_of(find_crossings(fibers, view)), crossings_of_pairs(fibers, view));
      view.is_perspective = true;
      view.eye = Vector3d(random.integer(-1, 1), random.integer(-1, 1), random.integer(-1, 1));
      EXPECT_EQ(keys_of(find_crossings(fibers, view)), crossings_of_pairs(fibers, view))
          << "inside";
    }
  }
}

// In every view of two closed curves, as often over as under by sign, and the same sum: the linking
// number. Only a count of each crossing at a vertex, on an edge-on segment or where the curves
// touch that is consistent, seen from all sides, has these properties.
TEST(Crossings, OnAGridGiveOneLinkingNumberFromAllSides) {
  SCOPED_TRACE(seed_message());
  Random random(5);
  int linked = 0;
  for (int round = 0; round < 60; ++round) {
    const FiberAssembly fibers =
        as_fibers({closed(grid_curve(random, 7, 2)), closed(grid_curve(random, 8, 2))});
    std::optional<int> linking_number;
    for (const View& view : grid_views()) {
      int over = 0;
      int under = 0;
      int count = 0;
      for (const Crossing& crossing : find_crossings(fibers, view)) {
        if (crossing.fiber_a != crossing.fiber_b) {
          (crossing.a_is_over ? over : under) += crossing.sign;
          ++count;
        }
      }
      ASSERT_EQ(count % 2, 0);
      ASSERT_EQ(over, under);
      ASSERT_EQ(over, linking_number.value_or(over));
      linking_number = over;
    }
    linked += *linking_number != 0 ? 1 : 0;
  }
  expect_enough(linked, 1);
}

TEST(Crossings, AtAVertexCountOnce) {
  const Curve straight{{-1, 0, 0}, {1, 0, 0}};
  const auto crossings = [&](const Curve& other) {
    return find_crossings(as_fibers({straight, other}), View());
  };
  const std::vector<Crossing> through = crossings({{-0.5, -1, 1}, {0.25, 0, 1}, {0.5, 1, 1}});
  ASSERT_EQ(through.size(), 1U);
  EXPECT_EQ(through[0].s, 0.625);
  EXPECT_EQ(through[0].segment_b + through[0].t, 1.0);
  EXPECT_FALSE(through[0].a_is_over);
  EXPECT_EQ(through[0].separation, 1.0);
  const std::vector<Crossing> touching = crossings({{-0.5, 1, 1}, {0.25, 0, 1}, {0.5, 1, 1}});
  EXPECT_EQ(touching.size() % 2, 0U);
  EXPECT_EQ(sum_of_signs(touching), 0);
  // Along the other for a while, then on to the other side, or back.
  EXPECT_EQ(crossings({{-0.5, -1, 1}, {-0.2, 0, 1}, {0.3, 0, 1}, {0.5, 1, 1}}).size() % 2, 1U);
  EXPECT_EQ(crossings({{-0.5, 1, 1}, {-0.2, 0, 1}, {0.3, 0, 1}, {0.5, 1, 1}}).size() % 2, 0U);
  // Seen end-on, and with a point twice.
  EXPECT_EQ(crossings({{-0.5, -1, 1}, {0, 0, 1}, {0, 0, 2}, {0.5, 1, 2}}).size() % 2, 1U);
  EXPECT_EQ(crossings({{-0.5, -1, 1}, {0, 0, 1}, {0, 0, 1}, {0.5, 1, 2}}).size(), 1U);
  // Vertex on vertex.
  EXPECT_EQ(find_crossings(
                as_fibers({{{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}}, {{0, -1, 1}, {0, 0, 1}, {0, 1, 1}}}),
                View())
                .size(),
            1U);
}

// The points of crossings lie on one ray of sight, also where only the perturbation makes them.
TEST(Crossings, OnAGridAreOnOneRay) {
  SCOPED_TRACE(seed_message());
  Random random(6);
  int count = 0;
  for (int round = 0; round < 20; ++round) {
    const FiberAssembly fibers = as_fibers({grid_curve(random, 12, 1), grid_curve(random, 12, 1)});
    for (const View& view : grid_views()) {
      for (const Crossing& crossing : find_crossings(fibers, view)) {
        const Vector3d ray = view.is_perspective
                                 ? Vector3d(crossing.point_a - view.eye).normalized()
                                 : view.direction.normalized();
        const Vector3d delta = crossing.point_b - crossing.point_a;
        ASSERT_LT(delta.cross(ray).norm(), 1e-10);
        ASSERT_NEAR(delta.norm(), crossing.separation, 1e-14);
        if (crossing.separation > 1e-9) {
          ASSERT_EQ(crossing.a_is_over, delta.dot(ray) > 0.0);
        }
        ++count;
      }
    }
  }
  expect_enough(count, 101);
}

TEST(Crossings, NeighboursAreNoPair) {
  // Seen along z, all is one line.
  EXPECT_EQ(find_crossings(as_fibers({{{0, 0, 0}, {1, 0, 1}, {0, 0, 2}}}), View()).size(), 0U);
  // The ends of a closed fibre, with a point three times.
  const Curve square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  for (const Vector3d& direction : {Vector3d(0, 0, 1), Vector3d(1, 2, 3)}) {
    EXPECT_EQ(find_crossings(as_fibers({square}), along(direction)).size(), 0U);
  }
  SCOPED_TRACE(seed_message());
  Random random(9);
  for (int round = 0; round < 50; ++round) {
    const Eigen::AngleAxisd rotation(random.uniform(0.0, 6.0), random.direction());
    const Curve ring = mapped(circle(5), [&](const Vector3d& p) { return Vector3d(rotation * p); });
    EXPECT_EQ(find_crossings(as_fibers({closed(ring)}), along(random.direction())).size(), 0U);
  }
  EXPECT_EQ(find_crossings(FiberAssembly(), View()).size(), 0U);
}

// Segments of no length cross nothing, and those before and after one are neighbours.
TEST(Crossings, StayWherePointsAreDoubled) {
  SCOPED_TRACE(seed_message());
  Random random(10);
  for (int round = 0; round < 20; ++round) {
    const Curve curve = random_curve(random, 15);
    Curve doubled;
    for (const Vector3d& point : curve) {
      doubled.insert(doubled.end(), 2, point);
    }
    const View view = random_view(random);
    const std::vector<Crossing> expected = find_crossings(as_fibers({curve}), view);
    const std::vector<Crossing> found = find_crossings(as_fibers({doubled}), view);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].segment_a, 2 * expected[i].segment_a + 1);
      EXPECT_EQ(found[i].segment_b, 2 * expected[i].segment_b + 1);
      EXPECT_EQ(found[i].sign, expected[i].sign);
    }
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
  const auto error_of = [](const View& view) -> std::string {
    try {
      find_crossings(FiberAssembly(), view);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  const std::string rule = ", coordinates must be finite and at most 1e150 m in magnitude";
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(error_of(along({0, 0, 0})), "direction of view: is 0,0,0, it must have a length");
  EXPECT_EQ(error_of(along({0, std::nan(""), 0})), "direction of view: y is nan" + rule);
  EXPECT_EQ(error_of(from({-infinity, 0, 0}, {1, 0, 0})), "eye: x is -inf" + rule);
  EXPECT_EQ(error_of(from({0, 0, 1e151}, {1, 0, 0})), "eye: z is 1e+151" + rule);
  EXPECT_EQ(error_of(along({0, 0, 1e-320})), "");
}

}  // namespace
}  // namespace fiber::test
