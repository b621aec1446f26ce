// Whatever the true points are within the uncertainty of the told ones, before a motion and after
// it: what is told of when contacts came holds for them.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "fiber_proximity/environment/environment.hpp"
#include "src/ros/detection/step_contacts.hpp"
#include "src/ros/detection/uncertainty.hpp"
#include "test/environment/random_shapes.hpp"
#include "test/ros/uncertain_fibers.hpp"
#include "test/support/answers.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber::Contact;
using fiber::Environment;
using fiber::EnvironmentObject;
using fiber::FiberAssembly;
using fiber::MotionContact;
using fiber::MotionResult;
using fiber::QueryOptions;
using fiber::QueryResult;
using fiber::QueryType;
using fiber::test::Random;
using uncertain_fibers::random_uncertainties;
using uncertain_fibers::true_fibers;
using uncertain_fibers::truths;

constexpr double tolerance = 1e-6;       // [m]
constexpr double true_tolerance = 1e-9;  // [m]
constexpr std::chrono::nanoseconds length(1000000000);

double part_of(std::chrono::nanoseconds time) {
  return static_cast<double>(time.count()) / static_cast<double>(length.count());
}

/// Something of the motion of true fibres.
struct TrueMotion {
  MotionResult result;
  std::vector<fiber::LastContact> last;  // of those that began in the motion
};

/// What is told of a step.
struct ToldStep {
  QueryOptions options;
  const MotionResult& motion;
  std::vector<StepContact> contacts;
  bool limit_reached;

  const StepContact* find(const MotionContact& pair) const {
    const auto found = std::find_if(contacts.begin(), contacts.end(), [&](const StepContact& each) {
      return each.key() == pair.key();
    });
    return found == contacts.end() ? nullptr : &*found;
  }
};

const MotionContact* find(const MotionResult& result, const MotionContact& pair) {
  for (const std::vector<MotionContact>* contacts : {&result.touching, &result.contacts}) {
    for (const MotionContact& contact : *contacts) {
      if (contact.key() == pair.key()) {
        return &contact;
      }
    }
  }
  return nullptr;
}

/// @returns how many contacts there were that are certain
std::size_t expect_holds(const ToldStep& told, const TrueMotion& truth) {
  constexpr double rounding = 2e-9;  // times are whole nanoseconds
  std::vector<MotionContact> true_contacts = truth.result.touching;
  true_contacts.insert(true_contacts.end(), truth.result.contacts.begin(),
                       truth.result.contacts.end());
  for (const MotionContact& pair : true_contacts) {
    if (!pair.certain) {
      continue;
    }
    const bool is_any =
        std::any_of(told.contacts.begin(), told.contacts.end(), [&](const StepContact& each) {
          return told.options.type != QueryType::FIBER_PAIRS ||
                 (each.contact.fiber_a == pair.fiber_a && each.contact.fiber_b == pair.fiber_b);
        });
    EXPECT_TRUE(is_any);
    const StepContact* const step = told.find(pair);
    if (step == nullptr) {
      EXPECT_NE(told.options.type, QueryType::ALL);
      continue;
    }
    EXPECT_LE(part_of(step->first.lower), pair.upper + rounding);
    if (find(told.motion, pair) != nullptr) {
      EXPECT_GE(part_of(step->first.upper), pair.lower - rounding);
    }
  }
  for (std::size_t i = 0; i < truth.last.size(); ++i) {
    const StepContact* const step = told.find(truth.result.contacts[i]);
    if (step != nullptr && step->state != StepContact::State::THERE) {
      EXPECT_FALSE(truth.last[i].lasts) << "it is not gone";
      EXPECT_GE(part_of(step->last.upper), truth.last[i].lower - rounding);
    }
  }
  std::size_t certain = 0;
  for (const std::vector<MotionContact>* contacts :
       {&told.motion.touching, &told.motion.contacts}) {
    for (const MotionContact& contact : *contacts) {
      if (contact.certain) {
        ++certain;
        const MotionContact* const pair = find(truth.result, contact);
        EXPECT_NE(pair, nullptr) << "it is not certain";
        EXPECT_TRUE(pair == nullptr || pair->lower <= contact.upper);
      }
    }
  }
  for (const StepContact& step : told.contacts) {
    if (step.state == StepContact::State::PASSED && step.was_certain) {
      EXPECT_TRUE(std::any_of(true_contacts.begin(), true_contacts.end(),
                              [&](const auto& pair) { return pair.key() == step.key(); }));
    }
  }
  return certain;
}

class UncertainMotionTest : public ::testing::Test {
 protected:
  static constexpr int rounds = fiber::test::rounds(60);
  static constexpr int truths_of_each = 6;

  void begin_round() {
    before = fiber::test::walks(random, 4, 12, 0.2, 0.02);
    std::vector<Eigen::Vector3d> points = before.points();
    for (std::uint32_t fiber = 0; fiber < before.fiber_count(); ++fiber) {
      const Eigen::Vector3d way = random.uniform(0.0, 1.0) * random.direction();
      for (std::uint32_t i = before.offsets()[fiber]; i < before.offsets()[fiber + 1]; ++i) {
        points[i] += way + random.uniform(0.0, 0.1) * random.direction();
      }
    }
    after = fiber::test::with_points(before, points);
    uncertainties = random_uncertainties(random, before.fiber_count());
    options = QueryOptions();
    options.type = types[type_++ % types.size()];
    options.neighbour_skip = 1;
    options.max_contacts = static_cast<std::uint32_t>(random.integer(1, 20));
    options.margin = random.uniform(0.0, 0.3);
    all_pairs = fiber::MotionOptions();
    all_pairs.margin = options.margin;
    all_pairs.neighbour_skip = 1;
    all_pairs.tolerance = true_tolerance;
    budget.begin(0.0, [] { return 0.0; }, {Stage::MOTION});
    budget.enter(Stage::MOTION);
  }

  ContinuousStep step() const {
    return {{before, after}, {std::chrono::nanoseconds(0), length}, tolerance, uncertainties};
  }

  /// @param now what is possible at the end
  ToldStep told(const QueryResult& now, const KnownMotion& motion) const {
    ToldStep told{options, motion.result, {}, motion.result.limit_reached};
    step_contacts(now.contacts, step().time, &motion, told.contacts);
    return told;
  }

  /// True fibres before and after, the same way off at both.
  std::pair<FiberAssembly, FiberAssembly> next_truth(const ToldStep& told, bool is_b_fiber) {
    const auto truth = truths[truth_++ % truths.size()];
    Contact aimed_at;
    aimed_at.normal = random.direction();
    if (!told.contacts.empty()) {
      aimed_at = told.contacts[static_cast<std::size_t>(
                                   random.integer(0, static_cast<int>(told.contacts.size()) - 1))]
                     .contact;
    }
    return {true_fibers(random, before, uncertainties, truth, aimed_at, is_b_fiber),
            true_fibers(random, after, uncertainties, truth, aimed_at, is_b_fiber)};
  }

  Random random;
  FiberAssembly before;
  FiberAssembly after;
  std::vector<double> uncertainties;
  QueryOptions options;
  fiber::MotionOptions all_pairs;  // of the true ones
  Budget budget;

 private:
  static constexpr std::array types{QueryType::ALL, QueryType::FIRST, QueryType::LIMITED,
                                    QueryType::FIBER_PAIRS};
  std::size_t truth_ = 0;
  std::size_t type_ = 0;
};

TEST_F(UncertainMotionTest, WhatIsToldOfFibersHoldsForAllTrueOnes) {
  SCOPED_TRACE(fiber::test::seed_message());
  const std::unique_ptr<fiber::ProximityEngine> engine = fiber::make_engine("run_tree");
  const std::unique_ptr<fiber::ProximityEngine> brute_force = fiber::make_engine("brute_force");
  std::size_t certain = 0;
  std::size_t possible = 0;
  std::size_t gone = 0;
  for (int round = 0; round < rounds; ++round) {
    begin_round();
    const Uncertainty uncertainty(uncertainties, Uncertainty::Bodies::BOTH);
    MotionResult result;
    const KnownMotion motion =
        detect_motion_contacts(*engine, step(), options, true, result, budget);
    QueryOptions now_options = options;
    now_options.type = QueryType::ALL;
    QueryResult now;
    query_possible(
        now_options, uncertainty,
        [&](const QueryOptions& asked, QueryResult& found) {
          found = fiber::test::brute_force(after, asked);
        },
        now);
    const ToldStep told = this->told(now, motion);
    possible += told.contacts.size();
    gone += static_cast<std::size_t>(std::count_if(
        told.contacts.begin(), told.contacts.end(),
        [](const StepContact& each) { return each.state != StepContact::State::THERE; }));
    for (int i = 0; i < truths_of_each; ++i) {
      const auto [true_before, true_after] = next_truth(told, true);
      TrueMotion truth;
      brute_force->update_motion(true_before, true_after);
      brute_force->query_motion(all_pairs, truth.result);
      const fiber::FiberMotion moved{true_before, true_after};
      truth.last = fiber::last_contacts(moved, moved, truth.result.contacts, all_pairs);
      certain += expect_holds(told, truth);
    }
    ASSERT_FALSE(HasFailure()) << "round " << round;
  }
  fiber::test::expect_enough(certain, std::size_t{100});
  fiber::test::expect_enough(possible, std::size_t{500});
  fiber::test::expect_enough(gone, std::size_t{50});
}

TEST_F(UncertainMotionTest, WhatIsToldOfObjectsHoldsForAllTrueFibers) {
  SCOPED_TRACE(fiber::test::seed_message());
  std::size_t certain = 0;
  std::size_t possible = 0;
  for (int round = 0; round < rounds; ++round) {
    begin_round();
    std::vector<EnvironmentObject> objects;
    for (int i = 0; i < 3; ++i) {
      EnvironmentObject& object = objects.emplace_back();
      object.name = "object" + std::to_string(i);
      object.shapes = {i == 0 ? fiber::PlacedShape{fiber::SphereShape{0.3}}
                              : fiber::PlacedShape{fiber::BoxShape{{0.3, 0.4, 0.5}}}};
      object.pose = fiber::test::random_pose(random, 1.0);
    }
    const auto earlier = std::make_shared<const Environment>(objects);
    for (EnvironmentObject& object : objects) {
      object.pose.pretranslate(random.uniform(0.0, 0.3) * random.direction());
    }
    const auto later = std::make_shared<const Environment>(objects);
    const Uncertainty uncertainty(uncertainties, Uncertainty::Bodies::A);
    MotionResult result;
    const KnownMotion motion = detect_motion_contacts(MovingEnvironment{earlier, later}, {}, step(),
                                                      options, true, result, budget);
    QueryOptions now_options = options;
    now_options.type = QueryType::ALL;
    QueryResult now;
    query_possible(
        now_options, uncertainty,
        [&](const QueryOptions& asked, QueryResult& found) {
          later->query(after, asked, {}, found);
        },
        now);
    const ToldStep told = this->told(now, motion);
    possible += told.contacts.size();
    for (int i = 0; i < truths_of_each; ++i) {
      const auto [true_before, true_after] = next_truth(told, false);
      TrueMotion truth;
      earlier->query_motion(true_before, true_after, *later, all_pairs, {}, truth.result);
      certain += expect_holds(told, truth);
    }
    ASSERT_FALSE(HasFailure()) << "round " << round;
  }
  fiber::test::expect_enough(certain, std::size_t{100});
  fiber::test::expect_enough(possible, std::size_t{300});
}

TEST_F(UncertainMotionTest, TheFirstThatIsPossibleIsNotHiddenByAnImpossibleOne) {
  begin_round();
  // The upper one of each pair passes over the lower one: of exact fibres first, with a gap of
  // 0.5 m, then of uncertain ones, with one of 0.6 m.
  const auto pairs_at = [](double of_exact, double of_uncertain) {
    return fiber::test::as_fibers({{{0, 0, 0}, {1, 0, 0}},
                                   {{0, of_exact, 0.5}, {1, of_exact, 0.5}},
                                   {{0, 0, 20}, {1, 0, 20}},
                                   {{0, of_uncertain, 20.6}, {1, of_uncertain, 20.6}}});
  };
  before = pairs_at(-1.0, -3.0);
  after = pairs_at(5.0, 3.0);
  uncertainties = {0.0, 0.0, 0.2, 0.2};
  options.margin = 0.3;
  const std::unique_ptr<fiber::ProximityEngine> engine = fiber::make_engine("run_tree");
  for (const QueryType type : {QueryType::FIRST, QueryType::CLOSEST, QueryType::LIMITED,
                               QueryType::ALL, QueryType::FIBER_PAIRS}) {
    options.type = type;
    options.max_contacts = 1;
    MotionResult result;
    const KnownMotion motion =
        detect_motion_contacts(*engine, step(), options, true, result, budget);
    const ToldStep told = this->told(QueryResult(), motion);
    ASSERT_EQ(told.contacts.size(), 1U);
    EXPECT_EQ(told.contacts[0].contact.fiber_a, 2U);
    EXPECT_EQ(told.contacts[0].state, StepContact::State::PASSED);
    EXPECT_FALSE(told.contacts[0].was_certain);
  }
}

TEST_F(UncertainMotionTest, FibersThatAreKnownExactlyAreTheQueryItself) {
  begin_round();
  const std::unique_ptr<fiber::ProximityEngine> engine = fiber::make_engine("run_tree");
  options.type = QueryType::ALL;
  uncertainties.assign(before.fiber_count(), 0.0);
  MotionResult zeros;
  detect_motion_contacts(*engine, step(), options, true, zeros, budget);
  uncertainties.clear();
  MotionResult none;
  detect_motion_contacts(*engine, step(), options, true, none, budget);
  ASSERT_FALSE(none.contacts.empty());
  ASSERT_EQ(zeros.contacts.size(), none.contacts.size());
  for (std::size_t i = 0; i < none.contacts.size(); ++i) {
    EXPECT_EQ(zeros.contacts[i].key(), none.contacts[i].key());
    EXPECT_EQ(zeros.contacts[i].lower, none.contacts[i].lower);
    EXPECT_EQ(zeros.contacts[i].upper, none.contacts[i].upper);
  }
}

}  // namespace
}  // namespace fiber_proximity_ros
