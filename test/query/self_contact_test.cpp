// Contacts of a fibre with itself need a loop: the default of QueryOptions, in every engine.
#include <gtest/gtest.h>

#include <algorithm>

#include "test/support/answers.hpp"
#include "test/support/cables.hpp"
#include "test/support/contacts.hpp"
#include "test/support/engines_test.hpp"
#include "test/support/not_finite.hpp"

namespace fiber::test {
namespace {

constexpr double nothing = 1e-6;  // [radii] what touching strands may be apart by rounding

/// Cables whose strands touch, coarsely and finely sampled.
std::vector<Cable> touching_cables() {
  std::vector<Cable> cables;
  for (const int count : {4, 5, 7, 10, 16, 45, 120, 400}) {
    cables.push_back(hairpin(6.2, count));
    cables.push_back(hairpin(30.0, count));
  }
  for (const double turns : {1.3, 2.0, 7.0}) {
    for (const int points_per_turn : {4, 5, 6, 9, 30, 100}) {
      cables.push_back(coil(2.6, turns, points_per_turn));
      cables.push_back(coil(8.0, turns, points_per_turn));
    }
  }
  for (const int count : {6, 9, 20, 60, 400}) {
    cables.push_back(open_ring(4.0, count));
    cables.push_back(open_ring(40.0, count));
  }
  for (const int count : {14, 24, 60, 400}) {
    cables.push_back(tight_knot(count));
  }
  return cables;
}

using SelfContactTest = EnginesTest;

TEST_P(SelfContactTest, CablesWithoutALoopHaveNoneAtAnyMargin) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const int count : {10, 45, 120}) {
    for (const double length : {20.0, 150.0, 2000.0}) {
      for (const Cable& cable : sampled(loopless_cables(count, length, random), random)) {
        SCOPED_TRACE(cable.name);
        const FiberAssembly fibers = cable.fibers(random.uniform(1e-4, 1e2));
        const double radius = fibers.largest_radius();
        for (const double margin : {0.0, radius, 8.0 * radius, 100.0 * radius, infinity}) {
          ASSERT_EQ(ask(fibers, within(margin)).contacts.size(), 0U) << "margin " << margin;
        }
        for (const QueryType type :
             {QueryType::FIRST, QueryType::CLOSEST, QueryType::LIMITED, QueryType::FIBER_PAIRS}) {
          const QueryResult none = ask(fibers, within(infinity, type));
          ASSERT_EQ(none.contacts.size(), 0U) << "type " << static_cast<int>(type);
          ASSERT_EQ(none.minimum_lower(), infinity);
        }
      }
    }
  }
}

TEST_P(SelfContactTest, StrandsThatTouchAreContactsAtEverySampling) {
  Random random;
  for (const Cable& cable : sampled(touching_cables(), random)) {
    SCOPED_TRACE(cable.name);
    const FiberAssembly fibers = cable.fibers();
    const QueryResult truth = brute_force(fibers, within(nothing));
    ASSERT_GT(truth.contacts.size(), 0U);
    ASSERT_TRUE(same_contacts(ask(fibers, within(nothing)).contacts, truth.contacts));
    for (const QueryType type : {QueryType::CLOSEST, QueryType::FIBER_PAIRS}) {
      const QueryResult closest = ask(fibers, within(infinity, type));
      ASSERT_EQ(closest.contacts.size(), 1U);
      ASSERT_LE(closest.contacts.front().distance, nothing);
      ASSERT_EQ(closest.contacts.front().distance, truth.closest()->distance);
    }
    ASSERT_EQ(ask(fibers, within(nothing, QueryType::FIRST)).contacts.size(), 1U);
  }
}

TEST_P(SelfContactTest, ALargerMarginHidesNone) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const Cable& cable : sampled(touching_cables(), random)) {
    if (cable.points.size() > 150) {
      continue;
    }
    SCOPED_TRACE(cable.name);
    const FiberAssembly fibers = cable.fibers();
    std::vector<Contact> before;
    for (const double margin : {0.0, nothing, 0.5, 3.0, 20.0, infinity}) {
      const std::vector<Contact> now = ask(fibers, within(margin)).contacts;
      for (const Contact& contact : before) {
        ASSERT_TRUE(contains(now, contact)) << "margin " << margin;
      }
      before = now;
    }
  }
}

TEST_P(SelfContactTest, AreThoseOfBruteForceAmongOtherFibers) {
  for_each_assembly(2, [this](const FiberAssembly& fibers, Random& random) {
    QueryOptions options = within(random.chance(0.3) ? infinity : random.uniform(0.0, 0.5));
    options.kernel = random.chance(0.5) ? Kernel::ROBUST : Kernel::EXACT;
    const QueryResult truth = brute_force(fibers, options);
    ASSERT_TRUE(same_contacts(ask(fibers, options).contacts, truth.contacts));
  });
}

TEST_P(SelfContactTest, ExplicitNeighbourSkipsNeedNoLoop) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const Cable& cable : loopless_cables(30, 20.0, random)) {
    SCOPED_TRACE(cable.name);
    const FiberAssembly fibers = cable.fibers();
    const auto skipping = [&](std::uint32_t skip) {
      QueryOptions options = within(infinity);
      options.neighbour_skip = skip;
      return ask(fibers, options).contacts.size();
    };
    EXPECT_EQ(skipping(0), 29U * 28U / 2U);
    EXPECT_EQ(skipping(1), 28U * 27U / 2U);
    EXPECT_EQ(skipping(5), 24U * 23U / 2U);
    QueryOptions options = within(infinity);
    options.neighbour_skip_length = 0.0;
    EXPECT_EQ(ask(fibers, options).contacts.size(), 28U * 27U / 2U);
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, SelfContactTest, engines_of_each_kind(), name_of_engine);

TEST(SelfContact, LongCablesWithoutALoopHaveNone) {
  SCOPED_TRACE(seed_message());
  Random random;
  const auto engine = make_engine("run_tree");
  for (const double length : {200.0, 4000.0}) {
    for (const Cable& cable : loopless_cables(2000, length, random)) {
      SCOPED_TRACE(cable.name);
      const FiberAssembly fibers = cable.fibers();
      engine->update(fibers);
      for (const double margin : {0.0, infinity}) {
        const QueryResult none = answer(*engine, within(margin, QueryType::CLOSEST));
        ASSERT_EQ(none.contacts.size(), 0U) << "margin " << margin;
      }
    }
  }
}

/// Candidates that are kept must not have been chosen by loops there were then.
TEST(SelfContactWithSkin, FollowsACableThatCloses) {
  const auto engine = make_engine("run_tree", {0, 3.0});
  FiberAssembly fibers = hairpin(30.0, 60).fibers();
  const Curve closed = fibers.points();
  bool has_kept = false;
  for (const double opening : {0.0, 0.1, 0.2, 0.3, 0.2, 0.1, 0.0, 0.4, 0.0}) {
    Curve points = closed;
    for (Eigen::Vector3d& point : points) {
      point.y() *= 1.0 + opening;
    }
    fibers.update_points(points);
    engine->update(fibers);
    for (const double margin : {0.0, nothing, 0.3, infinity}) {
      const QueryResult truth = brute_force(fibers, within(margin));
      ASSERT_TRUE(same_contacts(answer(*engine, within(margin)).contacts, truth.contacts))
          << opening;
      has_kept = has_kept || !truth.contacts.empty();
    }
  }
  EXPECT_TRUE(has_kept);
}

TEST(SelfContact, IsTheSameForAnyNumberOfThreads) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const Cable& cable : {tight_knot(1500), loopless_cables(1500, 3000.0, random)[4]}) {
    const FiberAssembly fibers = cable.fibers();
    QueryResult first;
    for (const std::uint32_t threads : {1U, 2U, 4U}) {
      const auto engine = make_engine("run_tree", {threads});
      engine->update(fibers);
      QueryResult found;
      engine->query(within(2.0 * fibers.largest_radius()), found);
      if (threads == 1) {
        first = found;
      }
      ASSERT_TRUE(same_contacts(found.contacts, first.contacts)) << threads << " threads";
    }
  }
}

}  // namespace
}  // namespace fiber::test
