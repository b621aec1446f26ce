// The time of an answer, shared by its stages.
#include "src/ros/detection/budget.hpp"

#include <gtest/gtest.h>

#include "fiber_proximity/query/options.hpp"

namespace fiber_proximity_ros {
namespace {

/// Gives answers whose time is told by a clock that goes only when something is done.
class BudgetTest : public testing::Test {
 protected:
  void begin(double deadline, const std::vector<Stage>& planned) {
    now_ = 0.0;
    budget_.begin(
        deadline, [this] { return now_; }, planned);
  }

  /// Something that no deadline shortens.
  void work(double seconds) { now_ += seconds; }

  /// Looks at pairs, as long as it may at most.
  /// @returns [s] how long that is
  double ask(double seconds) {
    double allowed = 0.0;
    fiber::QueryOptions options;
    options.deadline = 7.0;
    budget_.ask(options, [&](const fiber::QueryOptions& in_time) {
      allowed = in_time.deadline;
      now_ += std::min(seconds, allowed);
    });
    return allowed;
  }

  /// An answer about contacts, motion and prediction, with costs of 0.1, 0.2 and 0.3 s.
  void give_answer(double deadline) {
    begin(deadline, {Stage::CONTACTS, Stage::MOTION, Stage::OUTPUT, Stage::PREDICTION});
    budget_.enter(Stage::CONTACTS);
    work(0.1);
    contacts_ = ask(100.0);
    if (budget_.allows(Stage::MOTION)) {
      budget_.enter(Stage::MOTION);
      work(0.2);
      motion_ = ask(100.0);
    }
    budget_.enter(Stage::OUTPUT);
    work(0.5);
    if (budget_.allows(Stage::PREDICTION)) {
      budget_.enter(Stage::PREDICTION);
      work(0.3);
      prediction_ = ask(100.0);
    }
    budget_.end();
  }

  double now_ = 0.0;  // [s]
  Budget budget_;
  double contacts_ = 0.0;  // [s] shares
  double motion_ = 0.0;
  double prediction_ = 0.0;
};

TEST_F(BudgetTest, WithoutADeadlineTheOptionsStayAsTheyAre) {
  begin(0.0, {Stage::CONTACTS});
  EXPECT_FALSE(budget_.is_set());
  budget_.enter(Stage::CONTACTS);
  EXPECT_EQ(ask(1.0), 7.0);
  EXPECT_TRUE(budget_.allows(Stage::MOTION)) << "nothing is left out";
  EXPECT_TRUE(budget_.allows(Stage::DRAWING));
  budget_.end();
}

TEST_F(BudgetTest, AnAnswerEndsBeforeItsDeadlineOnceCostsAreKnown) {
  give_answer(10.0);
  EXPECT_GT(contacts_, (9.5 - 1.1) / 3.0) << "nothing was known yet";
  give_answer(10.0);
  EXPECT_NEAR(now_, 9.5, 1e-9);
  for (const double share : {contacts_, motion_, prediction_}) {
    EXPECT_NEAR(share, (9.5 - 1.1) / 3.0, 1e-9) << "equal shares of what is left";
  }
}

TEST_F(BudgetTest, WhatAPartDoesNotUseGoesToTheNextOnes) {
  give_answer(10.0);
  begin(10.0, {Stage::CONTACTS, Stage::MOTION, Stage::OUTPUT, Stage::PREDICTION});
  budget_.enter(Stage::CONTACTS);
  work(0.1);
  ask(0.0);
  budget_.enter(Stage::MOTION);
  work(0.2);
  EXPECT_NEAR(ask(0.0), (9.5 - 1.1) / 2.0, 1e-9);
  budget_.enter(Stage::OUTPUT);
  work(0.5);
  budget_.enter(Stage::PREDICTION);
  work(0.3);
  EXPECT_NEAR(ask(100.0), 9.5 - 1.1, 1e-9);
  EXPECT_NEAR(now_, 9.5, 1e-9);
}

TEST_F(BudgetTest, WhatThereIsNoTimeForIsLeftOutTheLastFirst) {
  give_answer(10.0);
  give_answer(2.0);  // 1.1 of which cannot be shortened
  EXPECT_TRUE(budget_.allows(Stage::MOTION));
  EXPECT_FALSE(budget_.allows(Stage::PREDICTION));
  EXPECT_NEAR(now_, 1.9, 1e-9);
  give_answer(1.3);
  EXPECT_FALSE(budget_.allows(Stage::MOTION));
  EXPECT_FALSE(budget_.allows(Stage::PREDICTION));
  EXPECT_NEAR(now_, 0.95 * 1.3, 1e-9);
  give_answer(0.2);
  EXPECT_NEAR(now_, 0.6, 1e-6) << "which updates and outputs take alone";
  EXPECT_LT(contacts_, 1e-6);
  int tried = 0;
  for (int answer = 0; answer < 2000; ++answer) {
    prediction_ = 0.0;
    give_answer(1.5);
    tried += prediction_ != 0.0 ? 1 : 0;
  }
  EXPECT_GT(tried, 0) << "it may have become cheaper";
  EXPECT_LT(tried, 20) << "it has not";
}

TEST_F(BudgetTest, DrawingWaitsWhereThereIsNoTime) {
  begin(1.0, {});
  EXPECT_TRUE(budget_.allows(Stage::DRAWING)) << "nobody knows what it takes";
  budget_.enter(Stage::DRAWING);
  work(0.4);
  budget_.end();
  begin(1.0, {});
  work(0.5);
  EXPECT_TRUE(budget_.allows(Stage::DRAWING));
  work(0.2);
  EXPECT_FALSE(budget_.allows(Stage::DRAWING));
}

TEST(StageCosts, AreUsualOnesAndWhatInterruptsIsNone) {
  StageCosts costs;
  EXPECT_EQ(costs.usual(), 0.0);
  EXPECT_EQ(costs.spread(), 0.0);
  for (int i = 0; i < 100; ++i) {
    costs.add(i % 20 == 0 ? 50.0 : 1.0 + 0.001 * (i % 3));
  }
  EXPECT_NEAR(costs.usual(), 1.0, 0.01);
  EXPECT_LE(costs.spread(), 0.01);
}

}  // namespace
}  // namespace fiber_proximity_ros
