#include "fiber_proximity/environment/check_fibers.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "fiber_proximity/query/fiber_snapshots.hpp"
#include "test/environment/random_shapes.hpp"
#include "test/support/seeded_test.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// Some of them are closed.
FiberAssembly random_fibers(Random& random, int fiber_count) {
  std::vector<Vector3d> points;
  FiberTopology topology;
  std::vector<std::uint32_t> offsets{0};
  for (int fiber = 0; fiber < fiber_count; ++fiber) {
    Vector3d point = random.in_cube();
    for (int i = random.integer(2, 20); i > 0; --i) {
      points.push_back(point);
      point += random.in_cube(0.1);
    }
    offsets.push_back(static_cast<std::uint32_t>(points.size()));
    const bool may_be_closed = offsets.back() - offsets[offsets.size() - 2] > 2;
    topology.closed.push_back(may_be_closed && random.chance(0.3) ? 1 : 0);
  }
  return {points, offsets, {0.01}, topology};
}

void expect_same(const QueryResult& found, const QueryResult& wanted) {
  ASSERT_EQ(found.contacts.size(), wanted.contacts.size());
  for (std::size_t i = 0; i < wanted.contacts.size(); ++i) {
    EXPECT_EQ(found.contacts[i].key(), wanted.contacts[i].key());
    EXPECT_EQ(found.contacts[i].distance, wanted.contacts[i].distance);
  }
}

class CheckFibersTest : public SeededTest {
 protected:
  CheckFibersTest() {
    std::vector<EnvironmentObject> objects;
    Vector3d far_away = Vector3d::Zero();  // from the only one without an end, too
    for (const Shape& shape : random_shapes(random_, 0.2)) {
      if (!std::holds_alternative<HalfSpaceShape>(shape)) {
        const Eigen::Isometry3d pose = random_pose(random_, 1.0);
        if (const auto* plane = std::get_if<PlaneShape>(&shape)) {
          far_away = 100.0 * (pose.linear() * plane->normal);
        }
        objects.push_back({"object" + std::to_string(objects.size()), pose, {{shape}}});
      }
    }
    environment_ = std::make_unique<const Environment>(objects);
    const FiberAssembly present = random_fibers(random_, 10);
    snapshots_.apply(present);
    present_ = snapshots_.newest();
    surroundings_.environment = environment_.get();
    surroundings_.fibers = present_->engine.get();
    for (int i = 0; i < 100; ++i) {
      candidates_.push_back(random_fibers(random_, random_.integer(1, 3)));
    }
    // Whatever was drawn, one is free and one is not.
    candidates_[1] = {{far_away, far_away + Vector3d(0.1, 0.0, 0.0)}, {0, 2}, {0.01}};
    candidates_[2] = present;
  }

  Random random_{seed(), 0};
  std::unique_ptr<const Environment> environment_;
  FiberSnapshots snapshots_;
  std::shared_ptr<const FiberSnapshot> present_;
  Surroundings surroundings_;
  std::vector<FiberAssembly> candidates_;
  std::vector<FiberCheck> checks_;
};

TEST_P(CheckFibersTest, AnswersAsTheThreeQueriesDo) {
  SCOPED_TRACE(seed_message());
  surroundings_.allowed = {{"object0", AllowedPair::every_fiber, 0, -1}};
  QueryOptions options;
  options.margin = 0.05;
  check_fibers(candidates_, surroundings_, options, checks_);
  ASSERT_EQ(checks_.size(), candidates_.size());
  const auto engine = make_engine("run_tree");
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    QueryResult wanted;
    environment_->query(candidates_[i], options, surroundings_.allowed, wanted);
    expect_same(checks_[i].environment, wanted);
    present_->engine->query_shape(candidates_[i], options, wanted);
    expect_same(checks_[i].fibers, wanted);
    engine->update(candidates_[i]);
    engine->query(options, wanted);
    expect_same(checks_[i].self, wanted);
    EXPECT_TRUE(checks_[i].is_complete());
  }
  EXPECT_TRUE(checks_[1].is_free());
  EXPECT_FALSE(checks_[2].is_free());
}

TEST_P(CheckFibersTest, TheFirstContactDecides) {
  SCOPED_TRACE(seed_message());
  QueryOptions options;
  check_fibers(candidates_, surroundings_, options, checks_);
  const std::vector<FiberCheck> all = checks_;
  options.type = QueryType::FIRST;
  check_fibers(candidates_, surroundings_, options, checks_);
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    EXPECT_EQ(checks_[i].is_free(), all[i].is_free());
    const std::size_t count = checks_[i].self.contacts.size() + checks_[i].fibers.contacts.size() +
                              checks_[i].environment.contacts.size();
    EXPECT_EQ(count, checks_[i].is_free() ? 0U : 1U);
  }
}

TEST_P(CheckFibersTest, OtherCandidatesDoNotDecideWhichContactIsFirst) {
  SCOPED_TRACE(seed_message());
  // As many points each: an engine might take one for another that has moved.
  std::vector<FiberAssembly> alike;
  for (int i = 0; i < 100; ++i) {
    std::vector<Vector3d> points;
    for (int point = 0; point < 60; ++point) {
      points.push_back(random_.in_cube());
    }
    alike.push_back({points, {0, 20, 40, 60}, {0.02}});
  }
  for (const double tolerance : {0.0, 0.1}) {
    QueryOptions options;
    options.type = tolerance > 0.0 ? QueryType::CLOSEST : QueryType::FIRST;
    options.tolerance = tolerance;
    check_fibers(alike, {}, options, checks_);
    std::vector<FiberCheck> alone;
    for (std::size_t i = 0; i < alike.size(); ++i) {
      check_fibers({alike[i]}, {}, options, alone);
      expect_same(checks_[i].self, alone[0].self);
    }
  }
}

TEST_P(CheckFibersTest, WhatIsLeftOutHasNoContacts) {
  QueryOptions options;
  options.margin = 10.0;
  surroundings_.fibers = nullptr;
  surroundings_.self = false;
  check_fibers(candidates_, surroundings_, options, checks_);
  EXPECT_TRUE(checks_[0].fibers.contacts.empty());
  EXPECT_TRUE(checks_[0].self.contacts.empty());
  EXPECT_FALSE(checks_[0].environment.contacts.empty());
  surroundings_.environment = nullptr;
  check_fibers(candidates_, surroundings_, options, checks_);
  EXPECT_TRUE(checks_[0].is_free());
}

TEST_P(CheckFibersTest, SaysWhichTheDeadlineDidNotReach) {
  QueryOptions options;
  options.margin = 10.0;
  check_fibers(candidates_, surroundings_, options, checks_);
  options.deadline = 1e-9;
  check_fibers(candidates_, surroundings_, options, checks_);
  // Nothing may be left of what was known of others before.
  for (const FiberCheck& check : checks_) {
    EXPECT_FALSE(check.is_complete());
    EXPECT_FALSE(check.is_free()) << "what is unknown is not free";
    EXPECT_FALSE(check.has_contact());
    EXPECT_FALSE(check.is_decided());
    for (const QueryResult* result : {&check.self, &check.fibers, &check.environment}) {
      EXPECT_EQ(result->minimum_lower(), -std::numeric_limits<double>::infinity());
    }
  }
  options.deadline = 0.0;
  options.margin = -1.0;
  EXPECT_THROW(check_fibers(candidates_, surroundings_, options, checks_), std::invalid_argument);
}

// No candidate happened to be free.
INSTANTIATE_TEST_SUITE_P(Seeds, CheckFibersTest, run_seed_and({2573467431, 1141829918}),
                         name_of_seed);

}  // namespace
}  // namespace fiber::test
