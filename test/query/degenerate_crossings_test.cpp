// Crossings where points coincide, line up or hide each other.
#include <gtest/gtest.h>

#include <optional>

#include "test/query/crossing_views.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/curves.hpp"
#include "test/support/exact_crossings.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

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

}  // namespace
}  // namespace fiber::test
