// Whole scenes that are hard on arithmetic: all engines agree with brute force to the bit, and
// brute force with exact arithmetic to what its kernel may err by.
#include "test/support/hard_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "test/support/answers.hpp"
#include "test/support/contacts.hpp"
#include "test/support/cuda_tree.hpp"
#include "test/support/engine_names.hpp"
#include "test/support/not_finite.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const AssemblyFamily& family : hard_scenes()) {
    names.push_back(family.name);
  }
  return names;
}

FiberAssembly make(const std::string& name, Random& random) {
  const std::vector<AssemblyFamily> families = hard_scenes();
  const auto family = std::find_if(families.begin(), families.end(),
                                   [&](const AssemblyFamily& other) { return other.name == name; });
  return family->make(random);
}

/// None, and the gap of a pair: just enough for it, just too little.
std::vector<double> hard_margins(const FiberAssembly& fibers, Random& random) {
  const std::vector<Contact> all = brute_force(fibers, within(infinity)).contacts;
  const int any = random.integer(0, static_cast<int>(all.size()) - 1);
  const double gap = std::max(0.0, all[static_cast<std::size_t>(any)].distance);
  return {0.0, gap, std::nextafter(gap, 0.0)};
}

class HardScenesEngineTest : public testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(HardScenesEngineTest, GivesBruteForcesContactsToTheBit) {
  SCOPED_TRACE(seed_message());
  Random random;
  const auto& [name, scene] = GetParam();
  const auto engine = make_engine(name);
  for (int frame = 0; frame < rounds(3); ++frame) {
    const FiberAssembly fibers = make(scene, random);
    engine->update(fibers);
    for (const double margin : hard_margins(fibers, random)) {
      SCOPED_TRACE("frame " + std::to_string(frame) + ", margin " + std::to_string(margin));
      QueryOptions options = within(margin);
      options.max_contacts = static_cast<std::uint32_t>(random.integer(1, 200));
      QueryResult found;
      for (const QueryType type :
           {QueryType::ALL, QueryType::CLOSEST, QueryType::LIMITED, QueryType::FIBER_PAIRS}) {
        options.type = type;
        engine->query(options, found);
        ASSERT_TRUE(same_contacts(found.contacts, brute_force(fibers, options).contacts))
            << "type " << static_cast<int>(type);
      }
      options.type = QueryType::ALL;
      const QueryResult all = brute_force(fibers, options);
      options.type = QueryType::FIRST;
      engine->query(options, found);
      ASSERT_EQ(found.contacts.size(), all.contacts.empty() ? 0U : 1U);
      ASSERT_TRUE(found.contacts.empty() || contains(all.contacts, found.contacts.front()));
    }
  }
}

std::vector<std::string> all_engines() {
  std::vector<std::string> names = with_cuda_tree(all_engine_names());
  names.insert(names.end(), {"DL-6", "DS-6", "DL-26", "DS-26", "DL-26-classic", "DS-26-classic"});
  return names;
}

INSTANTIATE_TEST_SUITE_P(Engines, HardScenesEngineTest,
                         testing::Combine(testing::ValuesIn(all_engines()),
                                          testing::ValuesIn(scene_names())),
                         [](const auto& instance) {
                           return test_name(std::get<0>(instance.param) + "_" +
                                            std::get<1>(instance.param));
                         });

class HardScenesTest : public testing::TestWithParam<std::string> {};

/// Whether the contact is one of the segments that start at these points.
bool is_of(const FiberAssembly& fibers, const Contact& contact, std::uint32_t a, std::uint32_t b) {
  return fibers.offsets()[contact.fiber_a] + contact.segment_a == a &&
         fibers.offsets()[contact.fiber_b] + contact.segment_b == b;
}

/// Largest difference of coordinates along one axis [m].
double extent(const Capsule& a, const Capsule& b) {
  const Eigen::Vector3d low = a.p0.cwiseMin(a.p1).cwiseMin(b.p0.cwiseMin(b.p1));
  const Eigen::Vector3d high = a.p0.cwiseMax(a.p1).cwiseMax(b.p0.cwiseMax(b.p1));
  return (high - low).maxCoeff();
}

/// [m] What a gap near this limit may be wrong by: four roundings of the distance, and those of the
/// sum of the radii and of the difference.
double gap_error(const Capsule& a, const Capsule& b, double limit) {
  return 4.0 * epsilon * extent(a, b) + epsilon * (a.radius + b.radius + limit);
}

TEST_P(HardScenesTest, BruteForceErrsByNoMoreThanItsKernel) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = make(GetParam(), random);
  const std::vector<std::uint32_t> starts = segments_of(fibers);
  for (const double margin : hard_margins(fibers, random)) {
    QueryOptions options = within(margin);
    options.neighbour_skip = 0;
    const std::vector<Contact> contacts = brute_force(fibers, options).contacts;
    std::size_t reported = 0;
    for (std::size_t i = 0; i < starts.size(); ++i) {
      for (std::size_t j = i + 1; j < starts.size(); ++j) {
        const Capsule a = fibers.capsule(starts[i]);
        const Capsule b = fibers.capsule(starts[j]);
        const bool in_contact =
            reported < contacts.size() && is_of(fibers, contacts[reported], starts[i], starts[j]);
        reported += in_contact ? 1 : 0;
        const double error = gap_error(a, b, margin);
        const ContactLimit limit{a.radius, b.radius, margin + (in_contact ? error : -error)};
        ASSERT_EQ(in_contact, exact_gap_at_most(a.p0, a.p1, b.p0, b.p1, limit))
            << "segments " << i << " and " << j << ", margin " << margin;
      }
    }
    ASSERT_EQ(reported, contacts.size());
  }
}

TEST_P(HardScenesTest, BruteForcesDistancesAreExactToFourRoundings) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = make(GetParam(), random);
  QueryOptions options = within(infinity);
  options.neighbour_skip = 0;
  const std::vector<Contact> contacts = brute_force(fibers, options).contacts;
  const std::size_t count = fibers.segment_count();
  ASSERT_EQ(contacts.size(), count * (count - 1) / 2);
  for (const Contact& contact : contacts) {
    const Capsule a = fibers.capsule(fibers.offsets()[contact.fiber_a] + contact.segment_a);
    const Capsule b = fibers.capsule(fibers.offsets()[contact.fiber_b] + contact.segment_b);
    const double distance = exact_segment_distance(a.p0, a.p1, b.p0, b.p1).distance;
    const double gap = distance - (a.radius + b.radius);
    ASSERT_NEAR(contact.distance, gap, gap_error(a, b, distance));
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, HardScenesTest, testing::ValuesIn(scene_names()),
                         [](const auto& instance) { return test_name(instance.param); });

/// Thousands of fibres in one place: all pairs are of one distance.
class CoincidentFibersTest : public testing::Test {
 protected:
  static FiberAssembly copies(int count, double radius) {
    Random random;
    const std::vector<Eigen::Vector3d> fiber = random_walk(random, 1, 0.1);
    return as_fibers(std::vector(count, fiber), radius);
  }
};

TEST_F(CoincidentFibersTest, AreBruteForcesNearestOfAThousand) {
  SCOPED_TRACE(seed_message());
  const auto engine = make_engine("run_tree");
  for (const double radius : {0.0, 0.01}) {
    const FiberAssembly fibers = copies(1000, radius);
    engine->update(fibers);
    for (const QueryType type : {QueryType::CLOSEST, QueryType::LIMITED, QueryType::FIRST}) {
      const QueryOptions options = within(0.0, type);
      const QueryResult found = answer(*engine, options);
      if (type == QueryType::FIRST) {
        ASSERT_EQ(found.contacts.size(), 1U);
        EXPECT_EQ(found.contacts.front().distance, -2.0 * radius);
      } else {
        EXPECT_TRUE(same_contacts(found.contacts, brute_force(fibers, options).contacts));
      }
    }
  }
}

TEST_F(CoincidentFibersTest, AreInContactAllWithAll) {
  SCOPED_TRACE(seed_message());
  constexpr std::uint32_t count = 1500;
  const FiberAssembly fibers = copies(count, 0.01);
  const auto engine = make_engine("run_tree");
  engine->update(fibers);
  for (const QueryType type : {QueryType::ALL, QueryType::FIBER_PAIRS}) {
    const QueryResult found = answer(*engine, within(0.0, type));
    ASSERT_EQ(found.contacts.size(), std::size_t{count} * (count - 1) / 2);
    const Contact* contact = found.contacts.data();
    for (std::uint32_t a = 0; a < count; ++a) {
      for (std::uint32_t b = a + 1; b < count; ++b, ++contact) {
        ASSERT_EQ(contact->fiber_a, a);
        ASSERT_EQ(contact->fiber_b, b);
        ASSERT_EQ(contact->distance, -0.02);
      }
    }
  }
}

}  // namespace
}  // namespace fiber::test
