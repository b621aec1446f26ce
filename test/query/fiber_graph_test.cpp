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

namespace fiber::test {
namespace {

using SegmentPair = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;

SegmentPair pair_in(const SegmentIdPair& pair) {
  return {pair.fiber_a, pair.segment_a, pair.fiber_b, pair.segment_b};
}

/// The contacts that there are, and those that rounding may decide about.
struct TrueContacts {
  std::set<SegmentPair> certain;
  std::set<SegmentPair> possible;  // and those that are certain
};

TrueContacts true_contacts(const JoinedFibers& fibers, const QueryOptions& options) {
  const GraphOracle oracle(fibers);
  TrueContacts contacts;
  const std::vector<GraphOracle::Segment>& segments = oracle.segments();
  for (std::size_t i = 0; i < segments.size(); ++i) {
    for (std::size_t j = i + 1; j < segments.size(); ++j) {
      const GraphOracle::Segment& a = segments[i];
      const GraphOracle::Segment& b = segments[j];
      if (oracle.nearest(a, b).distance - (a.radius + b.radius) <= options.margin &&
          !oracle.is_left_out(a, b, options, 1.0 - 1e-9)) {
        const SegmentPair pair{a.fiber, a.index, b.fiber, b.index};
        contacts.possible.insert(pair);
        if (!oracle.is_left_out(a, b, options, 1.0 + 1e-9)) {
          contacts.certain.insert(pair);
        }
      }
    }
  }
  return contacts;
}

testing::AssertionResult are_those(const std::vector<Contact>& found, const TrueContacts& truth) {
  std::set<SegmentPair> pairs;
  for (const Contact& contact : found) {
    pairs.insert(pair_in(contact));
  }
  const auto failure = [](const char* what, const SegmentPair& pair) {
    const auto& [fiber_a, segment_a, fiber_b, segment_b] = pair;
    return testing::AssertionFailure() << what << " fibre " << fiber_a << ", segment " << segment_a
                                       << " and fibre " << fiber_b << ", segment " << segment_b;
  };
  for (const SegmentPair& pair : truth.certain) {
    if (pairs.count(pair) == 0) {
      return failure("missing:", pair);
    }
  }
  for (const SegmentPair& pair : pairs) {
    if (truth.possible.count(pair) == 0) {
      return failure("no contact:", pair);
    }
  }
  return testing::AssertionSuccess();
}

/// Other places of the same fibres: what is joined moves together.
JoinedFibers bent(JoinedFibers fibers, Random& random) {
  const Eigen::Vector3d way = random.in_cube();
  const double waves = random.uniform(0.2, 2.0);
  for (Eigen::Vector3d& point : fibers.points) {
    point += 0.3 * std::sin(waves * point.dot(way)) * way;
  }
  return fibers;
}

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

/// Where a closed fibre begins is nothing that anybody sees.
TEST_P(FiberGraphTest, AnswersTheSameWhereverAClosedFiberBegins) {
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

TEST_P(FiberGraphTest, ARingTouchesItselfNowhere) {
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

TEST_P(FiberGraphTest, LinkedRingsTouchEachOtherAlone) {
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
TEST_P(FiberGraphTest, ClosedCoilsThatDoNotMeetHaveNoContacts) {
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
TEST_P(FiberGraphTest, ATreeWhoseBranchesDoNotMeetHasNoContacts) {
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

INSTANTIATE_TEST_SUITE_P(Engines, FiberGraphTest, all_engines(), name_of_engine);

/// Candidates that are kept are those of what was joined.
TEST(FiberGraph, OtherJointsOfTheSamePointsAreSeen) {
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
