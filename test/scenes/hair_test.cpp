#include "src/scenes/hair.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/query/engine.hpp"
#include "src/scenes/portable_math.hpp"
#include "src/scenes/scalp.hpp"
#include "test/support/error_of.hpp"
#include "test/support/hash.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

struct NamedStyle {
  std::string name;
  const HairStyle& style;
};

const std::vector<NamedStyle>& styles() {
  static const std::vector<NamedStyle> all{
      {"tress_a", tress_a}, {"tress_b", tress_b}, {"tress_c", tress_c}, {"charming", charming},
      {"curly", curly},     {"windy", windy},     {"longish", longish}};
  return all;
}

/// A scale at which a style has about this many hairs.
SceneOptions about(const HairStyle& style, double hairs, std::uint64_t seed = 1) {
  return {hairs / style.hair_count, seed};
}

/// Least level (see Head) on a segment.
double min_level(const Vector3d& p0, const Vector3d& p1) {
  const Vector3d a = Head::to_sphere(p0);
  const Vector3d u = Head::to_sphere(p1) - a;
  const double s = std::clamp(-a.dot(u) / u.squaredNorm(), 0.0, 1.0);
  return (a + s * u).norm();
}

TEST(PortableMath, SineAndCosineAreThoseOfLibm) {
  for (int i = -3000; i < 3000; ++i) {
    const double x = 0.001234 * i;
    ASSERT_NEAR(sine_of_turns(x), std::sin(2.0 * M_PI * x), 1e-13) << x;
    ASSERT_NEAR(cosine_of_turns(x), std::cos(2.0 * M_PI * x), 1e-13) << x;
  }
  EXPECT_EQ(sine_of_turns(0.0), 0.0);
  EXPECT_NEAR(cosine_of_turns(1e6), 1.0, 1e-13);
}

TEST(Head, LiftsWhatLiesBelowALevel) {
  EXPECT_DOUBLE_EQ(Head::level({0.0, 0.0, 0.115}), 1.0);
  EXPECT_DOUBLE_EQ(Head::level({0.0, 0.0375, 0.0}), 0.5);
  EXPECT_EQ(Head::lifted({0.2, 0.0, 0.0}, 1.0), Vector3d(0.2, 0.0, 0.0));
  EXPECT_NEAR((Head::lifted({0.0, 0.03, 0.0}, 1.2) - Vector3d(0.0, 0.09, 0.0)).norm(), 0.0, 1e-15);
}

TEST(Roots, AreAsDenseAsOnAScalp) {
  Random random(7);
  const std::vector<Root> roots = scalp_roots(charming.hair_count, random);
  ASSERT_EQ(roots.size(), charming.hair_count);
  double farthest = 0.0;
  for (const Root& root : roots) {
    ASSERT_NEAR(Head::level(root.point), 1.0, 1e-12);
    farthest = std::max(farthest, root.polar);
  }
  // 245 cm² of the head's 1100.
  EXPECT_GT(farthest, 50.0 / 360.0);
  EXPECT_LT(farthest, 70.0 / 360.0);
  constexpr double radius = 0.01;  // [m]
  int places = 0;
  for (std::size_t middle = 0; middle < roots.size(); middle += 1000) {
    if (roots[middle].polar > farthest - 0.03) {
      continue;  // a disc there would reach beyond the patch
    }
    ++places;
    const auto near = std::count_if(roots.begin(), roots.end(), [&](const Root& root) {
      return (root.point - roots[middle].point).norm() < radius;
    });
    EXPECT_NEAR(static_cast<double>(near), 200.0 * M_PI, 0.06 * 200.0 * M_PI)
        << "per π cm², at " << roots[middle].polar << " turns from the crown";
  }
  EXPECT_GT(places, 20);
}

TEST(Roots, OfATressAreAsDense) {
  Random random(7);
  const std::vector<Root> roots = disc_roots(2'500, random);
  const auto near = std::count_if(roots.begin(), roots.end(),
                                  [](const Root& root) { return root.point.norm() < 0.015; });
  EXPECT_NEAR(static_cast<double>(near), 200.0 * M_PI * 2.25, 0.02 * 200.0 * M_PI * 2.25);
  for (const Root& root : roots) {
    ASSERT_LT(root.point.norm(), std::sqrt(12.5 / M_PI) * 0.01 + 0.001);
    ASSERT_EQ(root.point.z(), 0.0);
  }
}

TEST(Roots, NeighboursInTheOrderAreNeighboursOnTheScalp) {
  Random random(7);
  std::vector<Root> roots = scalp_roots(20'000, random);
  const std::vector<Lock> locks = order_in_locks(roots, 0.006);
  ASSERT_EQ(roots.size(), 20'000U);
  // Along a Hilbert curve a run of n hairs covers about n cells of 0.7 mm by 0.7 mm.
  for (const std::size_t run : {1U, 16U, 256U, 4096U}) {
    double sum = 0.0;
    for (std::size_t i = 0; i + run < roots.size(); ++i) {
      sum += (roots[i + run].point - roots[i].point).norm();
    }
    const double mean = sum / static_cast<double>(roots.size() - run);
    EXPECT_LT(mean, 1.3 * 0.0007 * std::sqrt(static_cast<double>(run))) << run;
  }
  std::uint32_t next = 0;
  for (const Lock& lock : locks) {
    ASSERT_EQ(lock.begin, next);
    ASSERT_GT(lock.end, lock.begin);
    next = lock.end;
    for (std::uint32_t i = lock.begin; i < lock.end; ++i) {
      ASSERT_LT((roots[i].map - roots[lock.begin].map).norm(), 0.006 * std::sqrt(2.0));
    }
  }
  EXPECT_EQ(next, roots.size());
}

TEST(Hair, DoesNotPassThroughTheHead) {
  for (const auto& [name, style] : styles()) {
    if (!style.on_head) {
      continue;
    }
    for (const double hairs : {500.0, 5000.0, 30'000.0}) {
      SCOPED_TRACE(testing::Message() << name << ", " << hairs);
      const FiberAssembly fibers = hair(style, about(style, hairs, 3), 25);
      for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
        const std::uint32_t root = fibers.offsets()[fiber];
        ASSERT_NEAR(Head::level(fibers.points()[root]), 1.0, 1e-12);
        for (std::uint32_t i = root; i + 1 < fibers.offsets()[fiber + 1]; ++i) {
          const double level = min_level(fibers.points()[i], fibers.points()[i + 1]);
          ASSERT_GE(Head::level(fibers.points()[i + 1]), 1.0 + hair_clearance - 1e-12);
          // Beyond the root there is room for the hair's radius.
          ASSERT_GT(level, i == root ? 1.0 - 1e-12 : 1.0 + hair_radius / 0.075)
              << "fibre " << fiber << ", segment " << i - root;
        }
      }
    }
  }
}

TEST(Hair, HasSegmentsLongerThanThick) {
  for (const auto& [name, style] : styles()) {
    SCOPED_TRACE(name);
    const FiberAssembly fibers = hair(style, about(style, 400.0), 0);
    double shortest = 1.0;
    double longest = 0.0;
    for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
      for (std::uint32_t i = fibers.offsets()[fiber]; i + 1 < fibers.offsets()[fiber + 1]; ++i) {
        const double length = (fibers.points()[i + 1] - fibers.points()[i]).norm();
        shortest = std::min(shortest, length);
        longest = std::max(longest, length);
      }
    }
    EXPECT_GT(shortest, 4.0 * hair_radius) << "else neighbours but one would touch";
    EXPECT_LT(longest, 0.01);
  }
}

/// [m] Bound on the motion of a point from frame to frame: the slope of the sine, and by how much
/// lifting off the head stretches distances at most.
double max_hair_step(const HairStyle& style) {
  constexpr double stretch = 2.0;
  return stretch * tau * style.sway / sway_period;
}

TEST(Hair, MovesSmoothly) {
  for (const auto& [name, style] : styles()) {
    SCOPED_TRACE(name);
    const SceneOptions options = about(style, style.segments > 1000 ? 20.0 : 300.0, 2);
    const FiberAssembly first = hair(style, options, 0);
    FiberAssembly before = first;
    double farthest = 0.0;
    for (std::uint32_t frame = 1; frame <= sway_period; ++frame) {
      FiberAssembly now = hair(style, options, frame);
      for (std::size_t i = 0; i < now.point_count(); ++i) {
        farthest = std::max(farthest, (now.points()[i] - before.points()[i]).norm());
      }
      before = std::move(now);
    }
    EXPECT_LE(farthest, max_hair_step(style));
    EXPECT_GE(farthest, 0.2 * max_hair_step(style));
    EXPECT_EQ(before.points(), first.points()) << "the sway repeats";
  }
}

TEST(Hair, TouchesButNotEverywhere) {
  for (const auto& [name, style] : styles()) {
    SCOPED_TRACE(name);
    const FiberAssembly fibers =
        hair(style, about(style, style.segments > 1000 ? 150.0 : 1000.0), 0);
    const auto engine = make_engine("run_tree");
    engine->update(fibers);
    QueryResult result;
    engine->query({}, result);
    const double per_segment =
        static_cast<double>(result.contacts.size()) / static_cast<double>(fibers.segment_count());
    EXPECT_GT(per_segment, 0.02);
    EXPECT_LT(per_segment, 1.0);
  }
}

TEST(Hair, ScaleIsChecked) {
  EXPECT_EQ(hair(longish, {1e-9, 1}, 0).fiber_count(), 1U);
  EXPECT_EQ(hair(tress_a, {0.1, 1}, 0).fiber_count(), 250U);
  EXPECT_EQ(test::error_of([] {
              hair(charming, {2.7, 1}, 0);
            }),
            "scale is 2.7, it must be above 0 and at most 2.65");
}

TEST(Hair, ALargeScalpStaysOnTheHead) {
  Random random(1);
  const std::vector<Root> roots = scalp_roots(Head::max_hairs, random);
  for (const Root& root : roots) {
    ASSERT_LT(root.polar, 0.4) << "turns from the crown";
  }
}

// When a style changes on purpose, take the new values from this test's output.
TEST(Hair, IsTheSameBitsOnEveryMachine) {
  const std::vector<std::uint64_t> expected{
      14348534269475536967U, 9490593313876834598U,  9490593313876834598U, 9839022702097160673U,
      696818913066833950U,   15459173443923222407U, 865073449502582474U};
  std::vector<std::uint64_t> actual;
  for (const auto& [name, style] : styles()) {
    actual.push_back(test::hash(hair(style, about(style, 50.0, 6), 42)));
  }
  EXPECT_EQ(actual, expected);
}

}  // namespace
}  // namespace fiber
