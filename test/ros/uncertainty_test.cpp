// Whatever the true points are within the uncertainty of the told ones: what is answered about the
// told ones holds for them.
#include "src/ros/detection/uncertainty.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "fiber_proximity/environment/environment.hpp"
#include "src/ros/detection/detector.hpp"
#include "test/environment/random_shapes.hpp"
#include "test/ros/uncertain_fibers.hpp"
#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/random.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber::Contact;
using fiber::FiberAssembly;
using fiber::QueryOptions;
using fiber::QueryResult;
using fiber::QueryType;
using fiber::test::Random;
using Bodies = Uncertainty::Bodies;
using uncertain_fibers::random_uncertainties;
using uncertain_fibers::true_fibers;
using uncertain_fibers::Truth;
using uncertain_fibers::truths;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::array types{QueryType::FIRST, QueryType::CLOSEST, QueryType::LIMITED, QueryType::ALL,
                           QueryType::FIBER_PAIRS};

/// What was told about the told points.
struct Told {
  const QueryResult& result;
  QueryOptions options;
};

/// @param contacts by their keys
const Contact* find(const std::vector<Contact>& contacts, const Contact& pair) {
  const auto found = std::lower_bound(contacts.begin(), contacts.end(), pair, fiber::by_key);
  return found == contacts.end() || found->key() != pair.key() ? nullptr : &*found;
}

/// @param truth all pairs of the true points, whatever their distance
void expect_holds(const Told& told, const std::vector<Contact>& truth) {
  const double margin = told.options.margin;
  double others = infinity;
  for (const Contact& pair : truth) {
    const Contact* const contact = find(told.result.contacts, pair);
    if (contact != nullptr) {
      EXPECT_LE(contact->lower, pair.upper);
      EXPECT_GE(contact->upper, pair.lower);
      EXPECT_TRUE(!is_certain(*contact, margin) || pair.lower <= margin);
    } else {
      others = std::min(others, pair.upper);
    }
    if (pair.upper > margin) {
      continue;
    }
    switch (told.options.type) {
      case QueryType::FIRST:
      case QueryType::CLOSEST:
        EXPECT_FALSE(told.result.contacts.empty());
        break;
      case QueryType::LIMITED:
        EXPECT_TRUE(contact != nullptr || told.result.limit_reached);
        break;
      case QueryType::ALL:
        EXPECT_NE(contact, nullptr);
        break;
      case QueryType::FIBER_PAIRS:
        EXPECT_TRUE(std::any_of(told.result.contacts.begin(), told.result.contacts.end(),
                                [&](const Contact& x) {
                                  return x.fiber_a == pair.fiber_a && x.fiber_b == pair.fiber_b;
                                }));
        break;
    }
  }
  EXPECT_LE(told.result.others_lower, others);
}

QueryOptions random_options(Random& random, QueryType type) {
  QueryOptions options;
  options.type = type;
  options.neighbour_skip = 1;
  options.max_contacts = static_cast<std::uint32_t>(random.integer(1, 20));
  options.margin = random.chance(0.1) ? infinity : random.uniform(0.0, 0.15);
  options.tolerance = random.chance(0.2) ? 0.02 : 0.0;
  return options;
}

QueryOptions all_pairs() {
  QueryOptions options;
  options.neighbour_skip = 1;
  options.margin = infinity;
  return options;
}

const Contact& any_of(Random& random, const std::vector<Contact>& contacts) {
  return contacts[static_cast<std::size_t>(
      random.integer(0, static_cast<int>(contacts.size()) - 1))];
}

class UncertaintyTest : public ::testing::Test {
 protected:
  void begin_round() {
    told = fiber::test::walks(random, 4, 12, 0.2, 0.02);
    uncertainties = random_uncertainties(random, told.fiber_count());
  }

  /// @param near pairs of told points, by distance
  FiberAssembly next_truth(const std::vector<Contact>& pairs, bool is_b_fiber) {
    return true_fibers(random, told, uncertainties, truths[truth_++ % truths.size()],
                       any_of(random, pairs), is_b_fiber);
  }

  Random random;
  FiberAssembly told;
  std::vector<double> uncertainties;

 private:
  std::size_t truth_ = 0;
};

constexpr int rounds = fiber::test::rounds(30);
constexpr int truths_of_each = 6;

TEST_F(UncertaintyTest, AnswersAboutFibersHoldForAllTrueOnes) {
  SCOPED_TRACE(fiber::test::seed_message());
  for (int round = 0; round < rounds; ++round) {
    begin_round();
    QueryResult near = fiber::test::brute_force(told, all_pairs());
    fiber::sort_by_distance(near.contacts);
    near.contacts.resize(30);
    for (const QueryType type : types) {
      const QueryOptions options = random_options(random, type);
      Detector detector("run_tree");
      detector.set_fibers(told, uncertainties);
      detector.detect(options);
      const Detection& found = detector.detection();
      for (int i = 0; i < truths_of_each; ++i) {
        const FiberAssembly truth = next_truth(near.contacts, true);
        const QueryResult pairs = fiber::test::brute_force(truth, all_pairs());
        expect_holds({found.contacts(), options}, pairs.contacts);
        ASSERT_NE(pairs.closest(), nullptr);
        EXPECT_LE(found.minimum_lower(), pairs.closest()->upper);
        EXPECT_GE(found.minimum_upper(), pairs.closest()->lower);
      }
      ASSERT_FALSE(HasFailure()) << "round " << round;
    }
  }
}

TEST_F(UncertaintyTest, AnswersAboutObjectsHoldForAllTrueFibers) {
  SCOPED_TRACE(fiber::test::seed_message());
  for (int round = 0; round < rounds; ++round) {
    begin_round();
    std::vector<fiber::EnvironmentObject> objects;
    for (int i = 0; i < 3; ++i) {
      fiber::EnvironmentObject& object = objects.emplace_back();
      object.name = "object" + std::to_string(i);
      object.shapes = {i == 0 ? fiber::PlacedShape{fiber::SphereShape{0.3}}
                              : fiber::PlacedShape{fiber::BoxShape{{0.3, 0.4, 0.5}}}};
      object.pose = fiber::test::random_pose(random, 1.0);
    }
    const fiber::Environment environment(objects);
    QueryResult near;
    environment.query(told, all_pairs(), {}, near);
    for (const QueryType type : types) {
      const QueryOptions options = random_options(random, type);
      QueryResult result;
      query_possible(
          options, Uncertainty(uncertainties, Bodies::A),
          [&](const QueryOptions& asked, QueryResult& found) {
            environment.query(told, asked, {}, found);
          },
          result);
      for (int i = 0; i < truths_of_each; ++i) {
        QueryResult pairs;
        environment.query(next_truth(near.contacts, false), all_pairs(), {}, pairs);
        expect_holds({result, options}, pairs.contacts);
      }
      ASSERT_FALSE(HasFailure()) << "round " << round;
    }
  }
}

TEST_F(UncertaintyTest, AnswersAboutShapesHoldForAllTrueFibers) {
  SCOPED_TRACE(fiber::test::seed_message());
  for (int round = 0; round < rounds; ++round) {
    begin_round();
    const FiberAssembly shape = fiber::test::walks(random, 1, 5, 0.3, 0.05);
    // A round of the same with the bodies in the other order, to aim at.
    QueryResult near = fiber::test::brute_force(told, shape, all_pairs());
    const std::unique_ptr<fiber::ProximityEngine> engine = fiber::make_engine("run_tree");
    engine->update(told);
    const std::unique_ptr<fiber::ProximityEngine> enclosing = fiber::make_engine("run_tree");
    const FiberAssembly enclosing_them = enclosing_fibers(told, uncertainties);
    enclosing->update(enclosing_them);
    for (const QueryType type : types) {
      QueryOptions options = random_options(random, type);
      options.neighbour_skip.reset();
      QueryResult result;
      query_possible(
          options, Uncertainty(uncertainties, Bodies::B),
          [&](const QueryOptions& asked, QueryResult& found) {
            engine->query_shape(shape, asked, found);
          },
          result);
      QueryResult of_enclosing = fiber::test::answer(*enclosing, shape, options);
      for (Contact& contact : of_enclosing.contacts) {
        contact = told_contact(contact, uncertainties[contact.fiber_b]);
      }
      for (int i = 0; i < truths_of_each; ++i) {
        const FiberAssembly truth = next_truth(near.contacts, false);
        QueryOptions all = all_pairs();
        all.neighbour_skip.reset();
        const QueryResult pairs = fiber::test::brute_force(shape, truth, all);
        expect_holds({result, options}, pairs.contacts);
        expect_holds({of_enclosing, options}, pairs.contacts);
      }
      ASSERT_FALSE(HasFailure()) << "round " << round;
    }
  }
}

TEST_F(UncertaintyTest, WhatWasToldIsToldAndBoundsAreNoWiderThanBothBodiesAreUncertain) {
  begin_round();
  const QueryResult exact = fiber::test::brute_force(told, all_pairs());
  Detector detector("run_tree");
  detector.set_fibers(told, uncertainties);
  detector.detect(all_pairs());
  const QueryResult& possible = detector.detection().contacts();
  ASSERT_EQ(possible.contacts.size(), exact.contacts.size());
  for (std::size_t i = 0; i < exact.contacts.size(); ++i) {
    const Contact& contact = possible.contacts[i];
    const Contact& wanted = exact.contacts[i];
    ASSERT_EQ(contact.key(), wanted.key());
    EXPECT_EQ(contact.distance, wanted.distance);
    EXPECT_EQ(contact.point_a, wanted.point_a);
    const double by = uncertainties[contact.fiber_a] + uncertainties[contact.fiber_b];
    EXPECT_NEAR(contact.lower, wanted.lower - by, 1e-15);
    EXPECT_NEAR(contact.upper, wanted.upper + by, 1e-15);
    if (by == 0.0) {
      EXPECT_EQ(contact.lower, wanted.lower);
      EXPECT_EQ(contact.upper, wanted.upper);
    }
  }
}

TEST_F(UncertaintyTest, ThePairThatIsOnlyPossibleIsNotHiddenByACloserImpossibleOne) {
  // Two exact fibres 0.5 m apart, and two uncertain ones 0.6 m apart.
  const FiberAssembly fibers = fiber::test::as_fibers({{{0, 0, 0}, {1, 0, 0}},
                                                       {{0, 0.5, 0}, {1, 0.5, 0}},
                                                       {{0, 9, 0}, {1, 9, 0}},
                                                       {{0, 9.6, 0}, {1, 9.6, 0}}});
  for (const QueryType type : types) {
    QueryOptions options;
    options.type = type;
    options.margin = 0.3;
    options.max_contacts = 1;
    Detector detector("run_tree");
    detector.set_fibers(fibers, {0.0, 0.0, 0.2, 0.2});
    detector.detect(options);
    const Detection& found = detector.detection();
    ASSERT_EQ(found.contacts().contacts.size(), 1U);
    const Contact& contact = found.contacts().contacts.front();
    EXPECT_EQ(contact.fiber_a, 2U);
    EXPECT_EQ(contact.fiber_b, 3U);
    EXPECT_NEAR(contact.lower, 0.2, 1e-12);
    EXPECT_FALSE(is_certain(contact, options.margin));
    ASSERT_NE(found.minimum(), nullptr);
    EXPECT_EQ(found.minimum()->fiber_a, 0U);
    EXPECT_NEAR(found.minimum_lower(), 0.2, 1e-12);
    EXPECT_NEAR(found.minimum_upper(), 0.5, 1e-12);
  }
}

}  // namespace
}  // namespace fiber_proximity_ros
