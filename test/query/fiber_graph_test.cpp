// Closed and joined fibres in every engine, beside what the definitions say.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>

#include "test/support/answers.hpp"
#include "test/support/contacts.hpp"
#include "test/support/engines_test.hpp"
#include "test/support/graph_oracle.hpp"
#include "test/support/joined_fibers.hpp"
#include "test/support/neighbour_skips.hpp"
#include "test/support/not_finite.hpp"
#include "test/support/true_contacts.hpp"

namespace fiber::test {
namespace {

std::vector<Contact> sorted_by(bool (*before)(const Contact&, const Contact&),
                               std::vector<Contact> contacts) {
  std::sort(contacts.begin(), contacts.end(), before);
  return contacts;
}

using FiberGraphTest = EnginesTest;

TEST_P(FiberGraphTest, AnswersAsTheDefinitionsSay) {
  SCOPED_TRACE(seed_message());
  if (GetParam() == "AL-threaded") {
    GTEST_SKIP() << "fibres of different numbers of points";
  }
  Random random;
  std::size_t contacts = 0;
  const std::unique_ptr<ProximityEngine> engine = make_engine(GetParam());
  for (int round = 0; round < rounds(40); ++round) {
    JoinedFibers fibers = random_joined_fibers(random);
    SCOPED_TRACE(fibers.name + ", round " + std::to_string(round));
    FiberAssembly assembly = fibers.assembly();
    for (int frame = 0; frame < 3; ++frame) {
      if (frame > 0) {
        fibers = bent(fibers, random);
        assembly.update_points(fibers.points);
      }
      QueryOptions options = within(random.chance(0.4) ? 0.0 : random.uniform(0.0, 1.0));
      set_neighbour_skips(options, random, 4, random.chance(0.5) ? random.uniform(0.0, 2.0) : 0.0);
      options.pairing = static_cast<Pairing>(random.integer(0, 2));
      SCOPED_TRACE(skips_of(options) + ", margin " + std::to_string(options.margin));
      engine->update(assembly);
      const QueryResult all = answer(*engine, options);
      ASSERT_TRUE(are_those(all.contacts, true_contacts(fibers, options)));
      ASSERT_TRUE(same_contacts(all.contacts, brute_force(assembly, options).contacts));
      contacts += all.contacts.size();
      for (const QueryType type :
           {QueryType::FIRST, QueryType::CLOSEST, QueryType::LIMITED, QueryType::FIBER_PAIRS}) {
        options.type = type;
        options.max_contacts = 4;
        const QueryResult found = answer(*engine, options);
        if (type == QueryType::FIRST) {
          ASSERT_EQ(found.contacts.empty(), all.contacts.empty());
          ASSERT_TRUE(found.contacts.empty() || contains(all.contacts, found.contacts[0]));
          continue;
        }
        ASSERT_TRUE(same_contacts(found.contacts, brute_force(assembly, options).contacts));
        if (type == QueryType::CLOSEST && !all.contacts.empty()) {
          ASSERT_TRUE(identical(found.contacts.at(0), sorted_by(closer, all.contacts)[0]));
        }
      }
    }
  }
  expect_enough(contacts, std::size_t{1000});
}

TEST_P(FiberGraphTest, FindsTheSameInMotionsThatLeadNowhere) {
  SCOPED_TRACE(seed_message());
  if (GetParam() == "AL-threaded") {
    GTEST_SKIP() << "fibres of different numbers of points";
  }
  Random random;
  const std::unique_ptr<ProximityEngine> engine = make_engine(GetParam());
  std::size_t contacts = 0;
  for (int round = 0; round < rounds(20); ++round) {
    const JoinedFibers fibers = random_joined_fibers(random);
    SCOPED_TRACE(fibers.name + ", round " + std::to_string(round));
    const FiberAssembly before = fibers.assembly();
    MotionOptions options;
    options.margin = random.uniform(0.0, 0.5);
    options.tolerance = 0.0;
    if (random.chance(0.5)) {
      options.neighbour_skip = static_cast<std::uint32_t>(random.integer(0, 3));
    }
    QueryOptions pairs = pairs_of(options);
    pairs.kernel = Kernel::EXACT;
    engine->update_motion(before, before);
    MotionResult result;
    engine->query_motion(options, result);
    const QueryResult standing = brute_force(before, pairs);
    ASSERT_EQ(result.touching.size(), standing.contacts.size());
    for (std::size_t i = 0; i < standing.contacts.size(); ++i) {
      ASSERT_EQ(result.touching[i].key(), standing.contacts[i].key());
    }
    contacts += standing.contacts.size();
  }
  expect_enough(contacts, std::size_t{100});
}

/// Which pairs are asked about is decided by where the fibres were.
TEST_P(FiberGraphTest, MotionsBringContactsOfPairsAlone) {
  SCOPED_TRACE(seed_message());
  if (GetParam() == "AL-threaded") {
    GTEST_SKIP() << "fibres of different numbers of points";
  }
  Random random;
  const std::unique_ptr<ProximityEngine> engine = make_engine(GetParam());
  const std::unique_ptr<ProximityEngine> brute_force = make_engine("brute_force");
  std::size_t contacts = 0;
  for (int round = 0; round < rounds(12); ++round) {
    const JoinedFibers fibers = random_joined_fibers(random);
    SCOPED_TRACE(fibers.name + ", round " + std::to_string(round));
    const FiberAssembly before = fibers.assembly();
    FiberAssembly after = before;
    after.update_points(shaken(fibers, random).points);
    MotionOptions options;
    options.margin = random.uniform(0.0, 0.3);
    if (random.chance(0.5)) {
      options.neighbour_skip = static_cast<std::uint32_t>(random.integer(0, 3));
    }
    MotionResult expected;
    brute_force->update_motion(before, after);
    brute_force->query_motion(options, expected);
    MotionResult found;
    engine->update_motion(before, after);
    engine->query_motion(options, found);
    ASSERT_EQ(found.contacts.size(), expected.contacts.size());
    ASSERT_EQ(found.touching.size(), expected.touching.size());
    QueryOptions pairs = pairs_of(options);
    pairs.margin = infinity;
    const TrueContacts all = true_contacts(fibers, pairs);
    for (std::size_t i = 0; i < found.contacts.size(); ++i) {
      ASSERT_EQ(found.contacts[i].key(), expected.contacts[i].key());
      ASSERT_EQ(all.possible.count(pair_in(found.contacts[i])), 1U);
    }
    contacts += found.contacts.size();
  }
  expect_enough(contacts, std::size_t{100});
}

/// A chain, and the same cut in two at a point, which is a joint then.
TEST_P(FiberGraphTest, AFiberThatIsCutAndJoinedAnswersAsTheWholeOne) {
  SCOPED_TRACE(seed_message());
  if (GetParam() == "AL-threaded") {
    GTEST_SKIP() << "fibres of different numbers of points";
  }
  Random random;
  std::size_t contacts = 0;
  for (int round = 0; round < rounds(60); ++round) {
    Curve curve;
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    Eigen::Vector3d direction = random.direction();
    const int count = random.integer(3, 300);
    const double stiffness = random.uniform(0.0, 4.0);
    for (int i = 0; i < count; ++i) {
      curve.push_back(place);
      direction = (stiffness * direction + random.direction()).normalized();
      place += 0.3 * direction;
    }
    const auto cut = static_cast<std::uint32_t>(random.integer(1, count - 2));
    const double radius = random.uniform(0.02, 0.3);
    JoinedFibers parts;
    std::vector<std::int32_t> joints(cut + 1, -1);
    joints[cut] = 0;
    parts.add(Curve(curve.begin(), curve.begin() + cut + 1), radius, false, joints);
    parts.add(Curve(curve.begin() + cut, curve.end()), radius, false, {0});
    QueryOptions options = within(random.uniform(0.0, 0.5));
    options.neighbour_skip = random.chance(0.5) ? std::optional<std::uint32_t>()
                                                : static_cast<std::uint32_t>(random.integer(0, 5));
    const FiberAssembly whole(curve, {0, static_cast<std::uint32_t>(count)}, {radius});
    const std::vector<Contact> expected = ask(whole, options).contacts;
    std::vector<Contact> found = ask(parts.assembly(), options).contacts;
    for (Contact& contact : found) {
      contact.segment_a += contact.fiber_a * cut;
      contact.segment_b += contact.fiber_b * cut;
      contact.fiber_a = contact.fiber_b = 0;
    }
    sort_by_key(found);
    ASSERT_TRUE(same_contacts(found, expected)) << "round " << round << ", cut at " << cut;
    contacts += expected.size();
  }
  expect_enough(contacts, std::size_t{1000});
}

INSTANTIATE_TEST_SUITE_P(Engines, FiberGraphTest, engines_of_each_kind(), name_of_engine);

}  // namespace
}  // namespace fiber::test
