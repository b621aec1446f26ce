// Rods that begin inside of each other: found as brute force finds them, and moved apart.

#include "src/sim/overlaps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "src/sim/scene/reach.hpp"
#include "test/sim/random_rods.hpp"
#include "test/sim/tunnelling.hpp"
#include "test/support/random.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;
using Pairs = std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>,
                       double>;  // depth by rods and edges

constexpr double overlap_radius = 0.01;
constexpr std::uint32_t many = 100000;

void add(Rods& rods, const std::vector<Vector3d>& points) {
  rods.add(points, overlap_radius, rubber(overlap_radius));
}

/// All edges deeper in each other than a part of their radii's sum, by the rule for edges of one
/// rod: more than two edges apart, and four radii of rod between them.
Pairs brute_force_overlaps(const Rods& rods, double share) {
  Pairs pairs;
  const double largest = *std::max_element(rods.radii.begin(), rods.radii.end());
  for (std::uint32_t a = 0; a < rods.count(); ++a) {
    for (std::uint32_t b = a; b < rods.count(); ++b) {
      for (std::uint32_t i = rods.first(a); i + 1 < rods.end(a); ++i) {
        double between = 0.0;
        for (std::uint32_t j = a == b ? i + 1 : rods.first(b); j + 1 < rods.end(b); ++j) {
          const double touching = rods.radii[a] + rods.radii[b];
          const double depth = touching - edge_distance(rods.positions[i], rods.positions[i + 1],
                                                        rods.positions[j], rods.positions[j + 1]);
          if (depth > share * touching && (a != b || (j > i + 2 && between >= 4.0 * largest))) {
            pairs[{a, i - rods.first(a), b, j - rods.first(b)}] = depth;
          }
          between += rods.rest_lengths[j];
        }
      }
    }
  }
  return pairs;
}

OverlapFinder finder_of(bool same_fiber = true, bool different_fibers = true) {
  OverlapFinder::Options options;
  options.same_fiber = same_fiber;
  options.different_fibers = different_fibers;
  return OverlapFinder(options);
}

double farthest(const Rods& a, const Rods& b) {
  double distance = 0.0;
  for (std::size_t i = 0; i < a.positions.size(); ++i) {
    distance = std::max(distance, (a.positions[i] - b.positions[i]).norm());
  }
  return distance;
}

/// Separates rods that overlap, and looks at what has become of them without what did it.
Rods separated(const Rods& rods, double most_moved, double most_strain,
               std::vector<bool> is_held = {}) {
  is_held.resize(rods.positions.size(), false);
  EXPECT_FALSE(brute_force_overlaps(rods, touching_share).empty()) << "the scene is none";
  Rods moved = rods;
  OverlapFinder finder = finder_of();
  EXPECT_TRUE(separate_overlaps(moved, finder, is_held).empty());
  for (const auto& [pair, depth] : brute_force_overlaps(moved, touching_share)) {
    const auto [rod_a, edge_a, rod_b, edge_b] = pair;
    ADD_FAILURE() << "edge " << edge_a << " of rod " << rod_a << " is " << depth
                  << " m inside of edge " << edge_b << " of rod " << rod_b;
  }
  EXPECT_LT(farthest(rods, moved), most_moved);
  EXPECT_LT(largest_strain(moved).strain, most_strain);
  Rods again = rods;
  OverlapFinder second = finder_of();
  separate_overlaps(again, second, is_held);
  EXPECT_EQ(again.positions, moved.positions) << "it is not the same twice";
  return moved;
}

TEST(OverlapFinder, FindsWhatBruteForceFinds) {
  Random random(1);
  std::size_t found = 0;
  for (int round = 0; round < 100; ++round) {
    SCOPED_TRACE(seed_message() + ", round " + std::to_string(round));
    Rods rods;
    const double edge = overlap_radius * random.uniform(0.5, 4.0);
    for (int rod = 0; rod < 3; ++rod) {
      std::vector<Vector3d> points = random_chain(random, random.integer(5, 30), edge);
      const Vector3d start = points.front() - random.in_cube(5.0 * overlap_radius);
      for (Vector3d& point : points) {
        point -= start;
      }
      if (rod == 2) {
        points.front() = rods.positions[1];  // so that there is something to find
      }
      add(rods, points);
    }
    const Pairs expected = brute_force_overlaps(rods, touching_share);
    OverlapFinder finder = finder_of();
    Pairs pairs;
    double last = 1.0;
    for (const Overlap& overlap : finder.find(rods, touching_share, many)) {
      const Contact& contact = overlap.contact;
      pairs[{contact.fiber_a, contact.segment_a, contact.fiber_b, contact.segment_b}] =
          overlap.depth();
      EXPECT_LE(overlap.depth(), last) << "not the deepest first";
      last = overlap.depth();
    }
    ASSERT_EQ(pairs.size(), expected.size());
    for (const auto& [pair, depth] : expected) {
      ASSERT_EQ(pairs.count(pair), 1U);
      EXPECT_NEAR(pairs.at(pair), depth, 1e-12);
    }
    found += expected.size();
  }
  EXPECT_GE(found, 100U);
}

TEST(OverlapFinder, LooksOnlyForWhatItIsTold) {
  Rods rods;
  add(rods, {{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0.05, 0.1, 0}, {0.05, -0.1, 0}});
  add(rods, {{0, 0.05, 0}, {0.2, 0.05, 0}});
  const auto count = [&rods](bool same_fiber, bool different_fibers) {
    OverlapFinder finder = finder_of(same_fiber, different_fibers);
    return finder.find(rods, touching_share, many).size();
  };
  EXPECT_EQ(count(true, false), 1U);
  EXPECT_EQ(count(false, true), 2U);
  EXPECT_EQ(count(true, true), 3U);
  EXPECT_EQ(count(false, false), 0U);
}

TEST(OverlapFinder, RodsThatTouchDoNotOverlap) {
  Rods rods;
  add(rods, straight({0, 0, 0}, {1, 0, 0}, 7));
  add(rods, straight({0, 0, 2.0 * overlap_radius}, {1, 0.3, 2.0 * overlap_radius}, 5));
  add(rods, straight({0, 0.015, 1.99 * overlap_radius}, {1, 0.315, 1.99 * overlap_radius}, 5));
  OverlapFinder finder = finder_of();
  EXPECT_TRUE(finder.find(rods, touching_share, many).size() > 0);
  rods = Rods();
  add(rods, straight({0, 0, 0}, {1, 0, 0}, 7));
  add(rods, straight({0, 0, 1.985 * overlap_radius}, {1, 0.3, 1.985 * overlap_radius}, 5));
  EXPECT_TRUE(finder.find(rods, touching_share, many).empty());
}

/// Edges from far shorter than the rod is thick to far longer; crossing in nodes and within edges.
TEST(SeparateOverlaps, RodsThatCrossPartAcrossBoth) {
  for (const int segments : {1, 2, 5, 16, 100, 301}) {
    for (const double angle : {0.05, 0.5, 1.5707963267948966}) {
      for (const double shift : {0.0, 0.0031}) {
        SCOPED_TRACE(std::to_string(segments) + " segments, " + std::to_string(angle) + " rad");
        Rods rods;
        const Vector3d along(std::cos(angle), std::sin(angle), 0.0);
        add(rods, straight({-0.5 + shift, 0, 0}, {0.5 + shift, 0, 0}, segments));
        add(rods, straight(-0.5 * along, 0.5 * along, segments));
        const Rods moved = separated(rods, 3.0 * overlap_radius, 0.05);
        double highest = 0.0;
        for (std::size_t i = 0; i < moved.positions.size(); ++i) {
          const Vector3d way = moved.positions[i] - rods.positions[i];
          highest = std::max(highest, std::abs(way.z()));
          EXPECT_LT(way.head<2>().norm(), 0.3 * overlap_radius)
              << "node " << i << " not across both";
        }
        EXPECT_GT(highest, 0.99 * overlap_radius);
      }
    }
  }
}

TEST(SeparateOverlaps, RodsThatAreTheSamePart) {
  for (const Vector3d& end : {Vector3d(1, 0, 0), Vector3d(0, 0, 1), Vector3d(0.5, 0.6, -0.7)}) {
    for (const int segments : {1, 10, 101}) {
      SCOPED_TRACE(std::to_string(segments) + " segments");
      Rods rods;
      add(rods, straight({0, 0, 0}, end, 10));
      add(rods, straight({0, 0, 0}, end, segments));
      separated(rods, 3.0 * overlap_radius, 0.05);
    }
  }
  Rods rods;
  add(rods, straight({0, 0, 0}, {1, 0, 0}, 20));
  for (int i = 0; i < 4; ++i) {
    add(rods, straight({0, 0, 0}, {1, 0, 0}, 20));
  }
  separated(rods, 6.0 * overlap_radius, 0.1);
  // An arc, sampled in two ways.
  std::vector<Vector3d> arc;
  std::vector<Vector3d> finer;
  for (int i = 0; i <= 40; ++i) {
    arc.emplace_back(0.3 * std::cos(0.1 * i), 0.3 * std::sin(0.1 * i), 0.0);
  }
  for (int i = 0; i <= 130; ++i) {
    const double angle = 4.0 * i / 130.0;
    finer.emplace_back(0.3 * std::cos(angle), 0.3 * std::sin(angle), 0.0);
  }
  Rods arcs;
  add(arcs, arc);
  add(arcs, finer);
  separated(arcs, 3.0 * overlap_radius, 0.05);
}

/// Which edges of a rod are neighbours is told by their distance along it at rest.
TEST(OverlapFinder, FindsWhatIsPressedTogetherAlongTheRodToo) {
  std::vector<Vector3d> hexagon;
  for (int i = 0; i <= 6; ++i) {
    const double angle = M_PI * i / 3.0;
    hexagon.emplace_back(1.1 * overlap_radius * std::cos(angle),
                         1.1 * overlap_radius * std::sin(angle), 0.0);
  }
  Rods rods;
  add(rods, hexagon);
  for (Vector3d& position : rods.positions) {
    position *= 0.85;  // four edges are shorter than four radii now
  }
  const std::vector<Overlap> found = finder_of().find(rods, touching_share, many);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].contact.segment_a, 0U);
  EXPECT_EQ(found[0].contact.segment_b, 5U);
}

TEST(SeparateOverlaps, ARodThatRunsBackAlongItselfOpens) {
  for (const int segments : {20, 100}) {
    Rods rods;
    std::vector<Vector3d> points = straight({0, 0, 0}, {0.5, 0, 0}, segments);
    const std::vector<Vector3d> back = straight({0.5, 0, 0}, {0, 0, 0}, segments);
    points.insert(points.end(), back.begin() + 1, back.end());
    add(rods, points);
    separated(rods, 4.0 * overlap_radius, 0.6);
  }
}

TEST(SeparateOverlaps, SelfCrossingsPart) {
  // A figure of eight in a plane.
  std::vector<Vector3d> eight;
  for (int i = 0; i < 120; ++i) {
    const double t = 2.0 * M_PI * (i + 38) / 130.0;
    eight.emplace_back(0.3 * std::sin(t), 0.3 * std::sin(t) * std::cos(t), 0.0);
  }
  Rods rods;
  add(rods, eight);
  separated(rods, 3.0 * overlap_radius, 0.05);
}

TEST(SeparateOverlaps, HeapsPart) {
  for (std::uint64_t heap = 0; heap < 20; ++heap) {
    SCOPED_TRACE(seed_message() + ", heap " + std::to_string(heap));
    Random random(10 + heap);
    Rods rods;
    for (int rod = 0; rod < 8; ++rod) {
      // All through one place, in any direction.
      const Vector3d along = 0.3 * random.direction();
      add(rods, straight(-along, along, random.integer(3, 40)));
    }
    separated(rods, 12.0 * overlap_radius, 1.0);
  }
}

TEST(SeparateOverlaps, WhatIsFarStaysWhereItIs) {
  Rods rods;
  add(rods, straight({-0.5, 0, 0}, {0.5, 0, 0}, 100));
  add(rods, straight({0, -0.5, 0}, {0, 0.5, 0}, 100));
  add(rods, straight({-0.5, 0.3, 0.1}, {0.5, 0.3, 0.1}, 100));
  const Rods moved = separated(rods, 3.0 * overlap_radius, 0.05);
  for (std::uint32_t i = 0; i < rods.positions.size(); ++i) {
    const bool is_near = i < rods.first(2) && rods.positions[i].norm() < 0.22;
    if (!is_near) {
      EXPECT_EQ(moved.positions[i], rods.positions[i]) << i;
    }
  }
}

TEST(SeparateOverlaps, WhatIsHeldStays) {
  Rods rods;
  add(rods, straight({-0.5, 0, 0}, {0.5, 0, 0}, 50));
  add(rods, straight({0, -0.5, 0}, {0, 0.5, 0}, 50));
  std::vector<bool> is_held(rods.positions.size(), false);
  std::fill(is_held.begin(), is_held.begin() + rods.end(0), true);
  const Rods moved = separated(rods, 2.5 * overlap_radius, 0.1, is_held);
  for (std::uint32_t i = 0; i < rods.end(0); ++i) {
    EXPECT_EQ(moved.positions[i], rods.positions[i]);
  }
  // Both held: there is nothing to move.
  std::fill(is_held.begin(), is_held.end(), true);
  Rods stuck = rods;
  OverlapFinder finder = finder_of();
  EXPECT_FALSE(separate_overlaps(stuck, finder, is_held).empty());
  EXPECT_EQ(stuck.positions, rods.positions);
}

TEST(SeparateOverlaps, RodsLeaveObstacles) {
  const std::vector<Shape> shapes{SphereShape{0.05}, CylinderShape{0.05, 0.4},
                                  BoxShape{{0.1, 0.1, 0.1}}, HalfSpaceShape{}};
  for (const Shape& shape : shapes) {
    for (const double height : {-0.03, 0.0, 0.02, 0.0501}) {
      SCOPED_TRACE("shape " + std::to_string(shape.index()) + " at " + std::to_string(height));
      Rods rods;
      add(rods, straight({-0.5, 0.001, height}, {0.5, 0.002, height}, 100));
      OverlapFinder::Options options;
      options.environment = environment_of(shape);
      OverlapFinder finder(options);
      const std::vector<Overlap> before = finder.find(rods, touching_share, many);
      const std::vector<bool> is_held(rods.positions.size(), false);
      EXPECT_TRUE(separate_overlaps(rods, finder, is_held).empty());
      EXPECT_TRUE(finder.find(rods, touching_share, many).empty());
      if (!before.empty()) {
        EXPECT_TRUE(before.front().is_object);
        EXPECT_LT(largest_strain(rods).strain, 0.5);
      }
    }
  }
}

}  // namespace
}  // namespace fiber::test
