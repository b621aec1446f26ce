#include "src/ros/inputs/input_budget.hpp"

#include <gtest/gtest.h>

#include "test/support/assemblies.hpp"
#include "test/support/random.hpp"

namespace fiber_proximity_ros {
namespace {

fiber::FiberAssembly chain(std::size_t segments, double step) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i <= segments; ++i) {
    points.emplace_back(step * static_cast<double>(i), 0.0, 0.0);
  }
  const auto count = static_cast<std::uint32_t>(points.size());
  return {std::move(points), {0, count}, {0.01}};
}

/// One fibre in which nearly all segments are near all others.
fiber::FiberAssembly tangle(std::size_t segments) {
  fiber::test::Random random;
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i <= segments; ++i) {
    points.push_back(0.05 * random.in_cube());
  }
  const auto count = static_cast<std::uint32_t>(points.size());
  return {std::move(points), {0, count}, {0.01}};
}

CostLimits limits_of(std::uint32_t max_pairs, double max_time) {
  CostLimits limits;
  limits.max_pairs = max_pairs;
  limits.max_time = max_time;
  return limits;
}

TEST(CostOf, TellsFibresWithTooManyPairsAndNoOthers) {
  EXPECT_EQ(cost_of(chain(2000, 0.1), {}, limits_of(1000, 0.0)).problem, "");
  EXPECT_EQ(cost_of(tangle(200), {}, limits_of(0, 1000.0)).problem, "");
  const std::string problem = cost_of(tangle(200), {}, limits_of(1000, 0.0)).problem;
  EXPECT_EQ(problem.rfind("its 200 segments cost too much: by themselves they have more than 1000 "
                          "pairs within the margin of 0 m",
                          0),
            0U)
      << problem;
  // Of the node's own limits none hides what it costs.
  fiber::QueryOptions options;
  options.contact_limit = 10;
  options.deadline = 1e-9;
  options.pair_limit = 10;
  EXPECT_EQ(cost_of(tangle(200), options, limits_of(1000, 0.0)).problem, problem);
  EXPECT_EQ(cost_of(chain(2000, 0.1), options, limits_of(1000, 0.0)).problem, "");
}

TEST(CostOf, TellsFibresThatTakeTooLong) {
  const std::string problem = cost_of(tangle(3000), {}, limits_of(0, 1e-6)).problem;
  EXPECT_NE(problem.find("take longer than 1e-06 s (max_time)"), std::string::npos) << problem;
}

TEST(InputBudget, ManySegmentsAreTriedOnceAndAgainWhenTheyAreTwiceAsMany) {
  ros::Time::init();
  InputBudget budget(limits_of(1'000'000, 0.1));
  EXPECT_FALSE(budget.is_to_be_tried(chain(400, 0.1))) << "they have fewer pairs";
  EXPECT_TRUE(budget.is_to_be_tried(chain(500, 0.1))) << "their pairs may take so long";
  EXPECT_FALSE(InputBudget(limits_of(1'000'000, 0.0)).is_to_be_tried(chain(1000, 0.1)));
  EXPECT_TRUE(budget.is_to_be_tried(chain(2000, 0.1)));
  budget.take(chain(2000, 0.1), {"", 0.01});
  EXPECT_FALSE(budget.is_to_be_tried(chain(2000, 0.1)));
  EXPECT_FALSE(budget.is_to_be_tried(chain(4000, 0.1)));
  EXPECT_TRUE(budget.is_to_be_tried(chain(4001, 0.1)));
  EXPECT_FALSE(budget.is_closed());
  budget.doubt(10.0);
  EXPECT_FALSE(budget.is_to_be_tried(chain(2000, 0.1))) << "it has passed just now";
}

TEST(InputBudget, WhatCostsTooMuchIsNotReadForTwentyTimesAsLong) {
  ros::Time::init();
  InputBudget budget(limits_of(1000, 0.0));
  budget.take(chain(2000, 0.1), {"too much", 1000.0});
  EXPECT_EQ(budget.problem(), "too much");
  EXPECT_TRUE(budget.is_closed());
  budget.take(chain(2000, 0.1), {"too much", 0.0});
  EXPECT_FALSE(budget.is_closed()) << "it may be tried again";
  budget.take(chain(3, 0.1), {"", 0.0});
  EXPECT_EQ(budget.problem(), "");
}

TEST(InputBudget, WithoutLimitsNothingIsTried) {
  EXPECT_FALSE(InputBudget(limits_of(0, 0.0)).is_to_be_tried(chain(100'000, 0.1)));
}

}  // namespace
}  // namespace fiber_proximity_ros
