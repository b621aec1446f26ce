// Rings, coils, trees and forks that everybody knows the answer of, in every engine.
#include "test/support/joined_fibers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "test/support/answers.hpp"
#include "test/support/contacts.hpp"
#include "test/support/engines_test.hpp"
#include "test/support/not_finite.hpp"

namespace fiber::test {
namespace {

using JoinedFibersTest = EnginesTest;

/// Where a closed fibre begins is nothing that anybody sees.
TEST_P(JoinedFibersTest, AnswersTheSameWhereverAClosedFiberBegins) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::size_t contacts = 0;
  for (int round = 0; round < rounds(30); ++round) {
    const auto count = static_cast<std::uint32_t>(random.integer(12, 90));
    const Curve curve = random.chance(0.5) ? trefoil(static_cast<int>(count))
                                           : figure_eight(static_cast<int>(count));
    const double radius = random.uniform(0.05, 0.7);
    const auto shift = static_cast<std::uint32_t>(random.integer(1, static_cast<int>(count) - 1));
    Curve rotated = curve;
    std::rotate(rotated.begin(), rotated.begin() + shift, rotated.end());
    QueryOptions options = within(random.uniform(0.0, 1.0));
    if (random.chance(0.5)) {
      options.neighbour_skip = static_cast<std::uint32_t>(random.integer(0, 5));
    }
    const auto pairs_of_curve = [&](const Curve& points, std::uint32_t first) {
      std::set<std::set<std::uint32_t>> pairs;
      for (const Contact& contact :
           ask(FiberAssembly(points, {0, count}, {radius}, {{1}, {}, {}}), options).contacts) {
        pairs.insert({(contact.segment_a + first) % count, (contact.segment_b + first) % count});
      }
      return pairs;
    };
    const auto expected = pairs_of_curve(curve, 0);
    ASSERT_EQ(pairs_of_curve(rotated, shift), expected) << "round " << round << ", from " << shift;
    contacts += expected.size();
  }
  expect_enough(contacts, std::size_t{1000});
}

TEST_P(JoinedFibersTest, ARingTouchesItselfNowhere) {
  for (const int count : {3, 4, 5, 8, 30, 200}) {
    for (const double radius : {1e-6, 0.01, 0.2}) {
      const FiberAssembly ring(circle(count), {0, static_cast<std::uint32_t>(count)}, {radius},
                               {{1}, {}, {}});
      for (const double margin : {0.0, 0.1, infinity}) {
        // A way round is a loop where the ring is wide beside its radius, and is near all the same.
        const std::vector<Contact> found = ask(ring, within(margin)).contacts;
        ASSERT_EQ(found.size(), brute_force(ring, within(margin)).contacts.size());
        ASSERT_TRUE(margin == infinity || found.empty()) << count << " points, radius " << radius;
      }
    }
  }
}

TEST_P(JoinedFibersTest, LinkedRingsTouchEachOtherAlone) {
  JoinedFibers rings;
  rings.add(circle(40), 0.05, true);
  Curve second;
  for (const Eigen::Vector3d& point : circle(40)) {
    second.emplace_back(1.88 + point.x(), 0.0, point.y());
  }
  rings.add(second, 0.05, true);
  const std::vector<Contact> found = ask(rings.assembly(), within(0.05)).contacts;
  ASSERT_FALSE(found.empty());
  for (const Contact& contact : found) {
    EXPECT_NE(contact.fiber_a, contact.fiber_b);
  }
}

/// Coils as a magnet has them, side by side.
TEST_P(JoinedFibersTest, ClosedCoilsThatDoNotMeetHaveNoContacts) {
  JoinedFibers coils;
  for (int i = 0; i < 16; ++i) {
    Curve coil;
    for (int k = 0; k < 60; ++k) {
      const double t = turn * k / 60;
      coil.emplace_back(std::cos(t) + 0.1 * std::cos(3.0 * t), std::sin(t), 0.3 * i);
    }
    coils.add(coil, 0.05, true);
  }
  EXPECT_TRUE(ask(coils.assembly(), within(0.1)).contacts.empty());
  const QueryResult closest = ask(coils.assembly(), within(0.25, QueryType::CLOSEST));
  ASSERT_EQ(closest.contacts.size(), 1U);
  EXPECT_NEAR(closest.contacts[0].distance, 0.2, 1e-12);
}

/// A tree of 800 points in one plane whose branches spread and do not meet.
TEST_P(JoinedFibersTest, ATreeWhoseBranchesDoNotMeetHasNoContacts) {
  JoinedFibers tree;
  std::int32_t joint = 0;
  struct Bud {
    Eigen::Vector3d place;
    double angle;
    double spread;
    double radius;
    std::int32_t joint;
  };
  std::vector<Bud> buds{{{0, 0, 0}, 0.0, 0.7, 0.02, -1}};
  for (std::size_t i = 0; i < buds.size() && tree.points.size() < 800; ++i) {
    const Bud bud = buds[i];
    Curve curve;
    for (int k = 0; k < 13; ++k) {
      curve.emplace_back(bud.place +
                         0.2 * k * bud.spread *
                             Eigen::Vector3d(std::cos(bud.angle), std::sin(bud.angle), 0.0));
    }
    std::vector<std::int32_t> joints(curve.size(), -1);
    joints.front() = bud.joint;
    joints.back() = joint;
    tree.add(curve, bud.radius, false, joints);
    for (const double side : {-1.0, 1.0}) {
      buds.push_back(
          {curve.back(), bud.angle + side * bud.spread, 0.6 * bud.spread, 0.5 * bud.radius, joint});
    }
    ++joint;
  }
  ASSERT_GE(tree.points.size(), 800U);
  const FiberAssembly assembly = tree.assembly();
  EXPECT_TRUE(ask(assembly, within(0.0)).contacts.empty());
  const FiberAssembly apart(tree.points, tree.offsets, tree.radii);
  EXPECT_GT(ask(apart, within(0.0)).contacts.size(), 80U);
}

INSTANTIATE_TEST_SUITE_P(Engines, JoinedFibersTest, engines_of_each_kind(), name_of_engine);

/// Candidates that are kept are those of what was joined.
TEST(JoinedFibers, OtherJointsOfTheSamePointsAreSeen) {
  const Curve points{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  EngineOptions with_skin;
  with_skin.skin = 0.5;
  const std::unique_ptr<ProximityEngine> engine = make_engine("run_tree", with_skin);
  const FiberAssembly apart(points, {0, 2, 4}, {0.1});
  const FiberAssembly joined(points, {0, 2, 4}, {0.1}, {{}, {-1, 3, 3, -1}, {}});
  QueryOptions options;
  options.neighbour_skip = 1;
  for (int round = 0; round < 3; ++round) {
    engine->update(apart);
    EXPECT_EQ(answer(*engine, options).contacts.size(), 1U);
    engine->update(joined);
    EXPECT_EQ(answer(*engine, options).contacts.size(), 0U);
  }
}

}  // namespace
}  // namespace fiber::test
