// Motions of candidates: what a check of all their steps finds is what each step finds, asked
// alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <tuple>

#include "fiber_proximity/environment/check_fibers.hpp"
#include "fiber_proximity/query/fiber_snapshots.hpp"
#include "test/environment/motion_scene.hpp"
#include "test/support/error_of.hpp"
#include "test/support/not_finite.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;
using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;
using Firsts = std::map<Key, MotionContact>;

/// A cable of this many segments that goes through this many states.
FiberPath random_path(Random& random, int segments, int states, double way) {
  std::vector<Vector3d> points = random_cable(random, 0.6, segments);
  FiberPath path{cable(points, 0.01)};
  while (path.size() < static_cast<std::size_t>(states)) {
    const Vector3d common = random.in_cube(way);
    for (Vector3d& point : points) {
      point += common + random.in_cube(0.3 * way);
    }
    path.push_back(cable(points, random.chance(0.2) ? 0.015 : 0.01));
  }
  return path;
}

void add_firsts(const MotionResult& found, double step, Firsts& firsts) {
  for (const std::vector<MotionContact>* list : {&found.touching, &found.contacts}) {
    for (MotionContact contact : *list) {
      contact.lower += step;
      contact.upper += step;
      firsts.emplace(contact.key(), contact);
    }
  }
}

/// Of each of the three answers, step by step.
struct Expected {
  Firsts self;
  Firsts fibers;
  Firsts environment;

  const MotionContact* earliest() const {
    const MotionContact* first = nullptr;
    for (const Firsts* firsts : {&self, &fibers, &environment}) {
      for (const auto& [key, contact] : *firsts) {
        if (first == nullptr || contact.lower < first->lower) {
          first = &contact;
        }
      }
    }
    return first;
  }
};

void expect_same(const PathContacts& found, const Firsts& wanted) {
  EXPECT_TRUE(found.complete);
  EXPECT_FALSE(found.limit_reached);
  ASSERT_EQ(found.contacts.size(), wanted.size());
  auto expected = wanted.begin();
  for (const PathContact& contact : found.contacts) {
    EXPECT_EQ(contact.when.key(), expected->first);
    EXPECT_EQ(contact.where.key(), expected->first);
    EXPECT_EQ(contact.when.lower, expected->second.lower);
    EXPECT_EQ(contact.when.upper, expected->second.upper);
    EXPECT_EQ(contact.when.certain, expected->second.certain);
    ++expected;
  }
}

class CheckMotions : public testing::Test {
 protected:
  CheckMotions() {
    std::vector<EnvironmentObject> objects;
    for (const Shape& shape : random_shapes(random_, 0.15)) {
      if (!std::holds_alternative<HalfSpaceShape>(shape)) {
        objects.push_back({"object" + std::to_string(objects.size()),
                           random_pose(random_, 1.0),
                           {{shape, Eigen::Isometry3d::Identity()}}});
      }
    }
    environment_ = std::make_unique<const Environment>(objects);
    snapshots_.apply(cable(random_cable(random_, 1.0, 20), 0.01));
    present_ = snapshots_.newest();
    surroundings_.environment = environment_.get();
    surroundings_.fibers = present_->engine.get();
    for (int i = 0; i < rounds(150); ++i) {
      paths_.push_back(random_path(random_, random_.integer(1, 6), random_.integer(2, 5), 0.3));
    }
  }

  Expected expected_of(const FiberPath& path) const {
    Expected expected;
    const auto engine = make_engine("run_tree");
    const auto still = make_engine("run_tree");
    still->update_motion(present_->fibers, present_->fibers);
    MotionResult found;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      const auto step = static_cast<double>(i);
      environment_->query_motion(path[i], path[i + 1], *environment_, options_,
                                 surroundings_.allowed, found);
      add_firsts(found, step, expected.environment);
      still->query_motion_shape(path[i], path[i + 1], options_, found);
      add_firsts(found, step, expected.fibers);
      engine->update_motion(path[i], path[i + 1]);
      engine->query_motion(options_, found);
      add_firsts(found, step, expected.self);
    }
    return expected;
  }

  void check() { check_motions(paths_, surroundings_, options_, checks_); }

  Random random_;
  std::unique_ptr<const Environment> environment_;
  FiberSnapshots snapshots_;
  std::shared_ptr<const FiberSnapshot> present_;
  Surroundings surroundings_;
  std::vector<FiberPath> paths_;
  MotionOptions options_;
  std::vector<MotionCheck> checks_;
};

TEST_F(CheckMotions, AnswersWhatEachStepAnswers) {
  SCOPED_TRACE(seed_message());
  surroundings_.allowed = {{"object0", AllowedPair::every_fiber, 0, -1}};
  options_.margin = 0.01;
  check();
  ASSERT_EQ(checks_.size(), paths_.size());
  std::size_t found[3] = {};
  int free = 0;
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    SCOPED_TRACE(i);
    const Expected expected = expected_of(paths_[i]);
    expect_same(checks_[i].self, expected.self);
    expect_same(checks_[i].fibers, expected.fibers);
    expect_same(checks_[i].environment, expected.environment);
    EXPECT_EQ(checks_[i].is_free(), expected.earliest() == nullptr);
    found[0] += expected.self.size();
    found[1] += expected.fibers.size();
    found[2] += expected.environment.size();
    free += checks_[i].is_free() ? 1 : 0;
  }
  expect_enough(free, rounds(10));
  for (const std::size_t count : found) {
    expect_enough(count, static_cast<std::size_t>(rounds(20)));
  }
}

TEST_F(CheckMotions, ContactsAreWhereTheCandidateIsThen) {
  SCOPED_TRACE(seed_message());
  check();
  int count = 0;
  for (const MotionCheck& check : checks_) {
    for (const PathContacts* answer : {&check.self, &check.fibers, &check.environment}) {
      for (const PathContact& contact : answer->contacts) {
        if (contact.when.upper == std::floor(contact.when.upper)) {
          continue;  // at a state they may be deep in each other
        }
        EXPECT_LE(contact.where.lower, options_.margin + options_.tolerance);
        EXPECT_NEAR(contact.where.distance, options_.margin, 3e-3);
        ++count;
      }
    }
  }
  expect_enough(count, rounds(50));
}

TEST_F(CheckMotions, TheFirstIsTheEarliestOfAll) {
  SCOPED_TRACE(seed_message());
  options_.type = MotionType::FIRST;
  check();
  const std::vector<MotionCheck> firsts = checks_;
  options_.type = MotionType::ALL;
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    const Expected expected = expected_of(paths_[i]);
    const MotionContact* earliest = expected.earliest();
    std::vector<PathContact> found;
    for (const PathContacts* answer :
         {&firsts[i].self, &firsts[i].fibers, &firsts[i].environment}) {
      found.insert(found.end(), answer->contacts.begin(), answer->contacts.end());
      EXPECT_FALSE(answer->limit_reached);
    }
    ASSERT_EQ(found.size(), earliest == nullptr ? 0U : 1U);
    if (earliest != nullptr) {
      EXPECT_EQ(found[0].when.key(), earliest->key());
      EXPECT_EQ(found[0].when.lower, earliest->lower);
    }
  }
}

TEST_F(CheckMotions, LimitedAreTheEarliestOfEachAnswer) {
  SCOPED_TRACE(seed_message());
  options_.type = MotionType::LIMITED;
  options_.max_contacts = 2;
  check();
  const std::vector<MotionCheck> limited = checks_;
  options_.type = MotionType::ALL;
  check();
  int more = 0;
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    std::vector<MotionContact> all;
    for (const PathContact& contact : checks_[i].environment.contacts) {
      all.push_back(contact.when);
    }
    std::sort(all.begin(), all.end(),
              [](const MotionContact& x, const MotionContact& y) { return x.earlier_than(y); });
    const std::vector<PathContact>& found = limited[i].environment.contacts;
    ASSERT_EQ(found.size(), std::min<std::size_t>(all.size(), 2));
    for (const PathContact& contact : found) {
      const bool is_one = std::any_of(all.begin(), all.begin() + 2, [&](const MotionContact& x) {
        return x.key() == contact.when.key() && x.lower == contact.when.lower;
      });
      EXPECT_TRUE(is_one || all.size() < 2);
    }
    if (all.size() > 2) {
      EXPECT_TRUE(limited[i].environment.limit_reached);
      ++more;
    }
  }
  expect_enough(more, rounds(5));
}

TEST_F(CheckMotions, SayWhichTheDeadlineDidNotReach) {
  check();
  options_.deadline = 1e-9;
  check();
  for (const MotionCheck& check : checks_) {
    EXPECT_FALSE(check.has_contact());  // nothing is left of what was known before
    EXPECT_FALSE(check.is_complete());
    EXPECT_FALSE(check.is_free()) << "what is unknown is not free";
    EXPECT_FALSE(check.is_decided());
  }
}

TEST_F(CheckMotions, WhatIsLeftOutHasNoContacts) {
  options_.margin = 10.0;
  surroundings_.fibers = nullptr;
  surroundings_.self = false;
  check();
  EXPECT_FALSE(checks_[0].environment.contacts.empty());
  EXPECT_TRUE(checks_[0].self.contacts.empty() && checks_[0].fibers.contacts.empty());
  surroundings_.environment = nullptr;
  check();
  EXPECT_TRUE(checks_[0].is_free() && checks_[0].is_complete());
}

TEST_F(CheckMotions, RefuseWhatIsNoMotion) {
  paths_[3].resize(1);
  EXPECT_EQ(error_of([&] { check(); }), "motion 3 has 1 states, it needs at least 2");
  paths_[3] = random_path(random_, 4, 3, 0.1);
  paths_[3].push_back(random_path(random_, 5, 2, 0.1)[0]);
  EXPECT_EQ(error_of([&] { check(); }),
            "motion 3, state 3: the fibres change their topology: 1 of 5 points before, 1 of 6 "
            "after; a motion needs the same fibres with the same numbers of points");
  paths_[3].pop_back();
  for (const double tolerance : {-1e-9, infinity, std::nan("")}) {
    options_.tolerance = tolerance;
    EXPECT_THROW(check(), std::invalid_argument) << tolerance;
  }
  options_ = {};
  const auto fresh = make_engine("run_tree");
  surroundings_.fibers = fresh.get();
  EXPECT_THROW(check(), std::logic_error);
}

}  // namespace
}  // namespace fiber::test
