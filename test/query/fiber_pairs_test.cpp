// Queries for the closest contact of each pair of fibres.
#include <gtest/gtest.h>

#include <map>
#include <utility>

#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"
#include "test/support/engines_test.hpp"
#include "test/support/neighbour_skips.hpp"
#include "test/support/not_finite.hpp"
#include "test/support/random.hpp"

namespace fiber::test {
namespace {

/// Of each pair of fibres the closest of these contacts, the first of equals.
std::vector<Contact> closest_by_fibers(const std::vector<Contact>& contacts) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Contact> by_fibers;
  for (const Contact& contact : contacts) {
    const auto [entry, is_new] = by_fibers.try_emplace({contact.fiber_a, contact.fiber_b}, contact);
    if (!is_new && contact.distance < entry->second.distance) {
      entry->second = contact;
    }
  }
  std::vector<Contact> closest;
  for (const auto& [fibers, contact] : by_fibers) {
    closest.push_back(contact);
  }
  sort_by_key(closest);
  return closest;
}

/// From touching to everything.
std::vector<double> margins(const FiberAssembly& fibers) {
  const double size = extent_of(fibers);
  return {0.0, 1e-3 * size, 0.1 * size, size, infinity};
}

QueryOptions of_all(double margin, Random& random) {
  QueryOptions options = within(margin);
  set_neighbour_skips(options, random, 3, 0.0);
  return options;
}

QueryOptions of_fiber_pairs(QueryOptions options) {
  options.type = QueryType::FIBER_PAIRS;
  return options;
}

class FiberPairsTest : public testing::TestWithParam<std::string> {
 protected:
  FiberAssembly make(const AssemblyFamily& family, Random& random) const {
    FiberAssembly fibers = family.make(random);
    return GetParam() == "AL-threaded" ? equal_fibers(fibers) : fibers;
  }

  void expect_closest(const FiberAssembly& fibers, const QueryOptions& all) {
    engine_->update(fibers);
    engine_->query(of_fiber_pairs(all), found_);
    const QueryResult expected = brute_force(fibers, all);
    ASSERT_TRUE(same_contacts(found_.contacts, closest_by_fibers(expected.contacts)))
        << "margin " << all.margin << ", " << skips_of(all);
    EXPECT_FALSE(found_.limit_reached);
    EXPECT_LE(found_.counts.primitive_tests, expected.counts.primitive_tests);
  }

  std::unique_ptr<ProximityEngine> engine_ = make_engine(GetParam());
  QueryResult found_;  // one for all queries: what is left of one must not matter to the next
};

TEST_P(FiberPairsTest, GivesTheClosestOfAllContactsOnEveryFamily) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const AssemblyFamily& family : sampled(assembly_families(), random)) {
    SCOPED_TRACE(family.name);
    for (int round = 0; round < 2; ++round) {
      const FiberAssembly fibers = make(family, random);
      for (const double margin : margins(fibers)) {
        QueryOptions all = of_all(margin, random);
        ASSERT_NO_FATAL_FAILURE(expect_closest(fibers, all));
        all.neighbour_skip_length = 0.3 * margins(fibers)[3];
        ASSERT_NO_FATAL_FAILURE(expect_closest(fibers, all));
      }
    }
  }
}

TEST_P(FiberPairsTest, GivesTheClosestOfAllContactsOfEachFiberOfAShape) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const AssemblyFamily& family : sampled(assembly_families(), random)) {
    SCOPED_TRACE(family.name);
    for (int round = 0; round < 2; ++round) {
      const FiberAssembly fibers = make(family, random);
      const FiberAssembly shape = make(family, random);
      engine_->update(fibers);
      for (const double margin : margins(fibers)) {
        const QueryOptions all = of_all(margin, random);
        engine_->query_shape(shape, of_fiber_pairs(all), found_);
        const QueryResult expected = brute_force(shape, fibers, all);
        ASSERT_TRUE(same_contacts(found_.contacts, closest_by_fibers(expected.contacts)))
            << "margin " << margin;
      }
    }
  }
}

TEST_P(FiberPairsTest, RemembersThousandsOfPairs) {
  SCOPED_TRACE(seed_message());
  Random random;
  constexpr std::size_t count = 120;
  const FiberAssembly fibers = walks(random, count, 4, 0.1, 0.01);
  ASSERT_NO_FATAL_FAILURE(expect_closest(fibers, of_all(0.1, random)));
  QueryOptions everything = of_all(infinity, random);
  everything.neighbour_skip = 4;  // more than a fibre has: no pair with itself
  ASSERT_NO_FATAL_FAILURE(expect_closest(fibers, everything));
  EXPECT_EQ(found_.contacts.size(), count * (count - 1) / 2);
}

INSTANTIATE_TEST_SUITE_P(Engines, FiberPairsTest, all_engines(), name_of_engine);

QueryResult ask(const FiberAssembly& fibers, double margin) {
  return brute_force(fibers, within(margin, QueryType::FIBER_PAIRS));
}

// A hairpin of three segments, 1 m wide, and a fibre of two segments, 3 m beside it.
TEST(FiberPairs, AreThoseOfAFiberWithItselfToo) {
  const FiberAssembly fibers(
      {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {0, 1, 0}, {0, 4, 0}, {2, 4, 0}, {4, 4, 0}}, {0, 4, 7},
      {0.25});
  const QueryResult two = ask(fibers, infinity);
  ASSERT_EQ(two.contacts.size(), 2U) << "the second fibre has neighbours only";
  EXPECT_EQ(two.contacts[0].key(), std::make_tuple(0U, 0U, 0U, 2U));
  EXPECT_EQ(two.contacts[0].distance, 0.5);
  EXPECT_EQ(two.contacts[1].key(), std::make_tuple(0U, 1U, 1U, 1U)) << "the first of four";
  EXPECT_EQ(two.contacts[1].distance, 2.5);
  EXPECT_EQ(ask(fibers, 2.5).contacts.size(), 2U) << "the margin is inclusive";
  EXPECT_EQ(ask(fibers, std::nextafter(2.5, 0.0)).contacts.size(), 1U);
  EXPECT_TRUE(ask(fibers, 0.25).contacts.empty());
}

TEST(FiberPairs, TestFewerSegmentsThanThereAre) {
  std::vector<Eigen::Vector3d> points;
  for (const double y : {0.0, 1.0}) {
    for (int i = 0; i <= 100; ++i) {
      points.emplace_back(i, y, 0.0);
    }
  }
  const FiberAssembly fibers(points, {0, 101, 202}, {0.0});
  QueryOptions options = within(infinity, QueryType::FIBER_PAIRS);
  options.neighbour_skip = 100;
  const QueryResult result = brute_force(fibers, options);
  ASSERT_EQ(result.contacts.size(), 1U);
  EXPECT_EQ(result.contacts.front().key(), std::make_tuple(0U, 0U, 1U, 0U));
  EXPECT_LT(result.counts.primitive_tests, 1000U) << "of 10000";
}

}  // namespace
}  // namespace fiber::test
