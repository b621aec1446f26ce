#include "src/accuracy/resampling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "src/accuracy/frame_order.hpp"

namespace fiber::test {
namespace {

/// An arc of a metre's radius over a right angle, of 101 points, and a straight fibre of 11.
FiberAssembly arc_and_line(double bend = 1.0) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= 100; ++i) {
    const double angle = bend * M_PI_2 * i / 100.0;
    points.emplace_back(std::cos(angle), std::sin(angle), 0.0);
  }
  for (int i = 0; i <= 10; ++i) {
    points.emplace_back(0.1 * i, 0.0, 1.0);
  }
  return {points, {0, 101, 112}, {0.01, 0.02}};
}

TEST(Resampling, EveryPointIsNearAChord) {
  const FiberAssembly fibers = arc_and_line();
  std::size_t last = fibers.point_count();
  for (const double error : {1e-4, 3e-4, 1e-3, 1e-2}) {
    const std::vector<std::uint32_t> stay = enough_points({&fibers}, error);
    EXPECT_LT(stay.size(), last);
    last = stay.size();
    for (std::size_t i = 0; i + 1 < stay.size() && stay[i + 1] <= 100; ++i) {
      // A chord of an angle is 1 − cos(angle / 2) from the arc.
      const double angle = M_PI_2 * (stay[i + 1] - stay[i]) / 100.0;
      EXPECT_LE(1.0 - std::cos(0.5 * angle), 1.001 * error);
    }
  }
  EXPECT_LE(last, 12U) << "a line needs its ends only";
}

TEST(Resampling, AllStatesCount) {
  const FiberAssembly straight = arc_and_line(1e-6);
  const FiberAssembly bent = arc_and_line();
  EXPECT_EQ(enough_points({&straight}, 1e-3).size(), 4U);
  EXPECT_EQ(enough_points({&straight, &bent}, 1e-3), enough_points({&bent}, 1e-3));
}

TEST(Resampling, FibresKeepTheirEndsAndRadii) {
  const FiberAssembly fibers = arc_and_line();
  const std::vector<std::uint32_t> stay = enough_points({&fibers}, 1e-3);
  const FiberAssembly fewer = select_points(fibers, stay);
  EXPECT_EQ(fewer.fiber_count(), 2U);
  EXPECT_EQ(fewer.point_count(), stay.size());
  EXPECT_EQ(fewer.points().front(), fibers.points().front());
  EXPECT_EQ(fewer.points().back(), fibers.points().back());
  EXPECT_EQ(fewer.radius_at(0, 0), 0.01);
  EXPECT_EQ(fewer.radius_at(1, fewer.point_count() - 1), 0.02);
}

TEST(Resampling, WhatIsJoinedStays) {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::int32_t> joints(60, -1);
  for (int i = 0; i < 40; ++i) {
    points.emplace_back(std::cos(M_PI * i / 20), std::sin(M_PI * i / 20), 0.0);
  }
  for (int i = 0; i < 20; ++i) {
    points.emplace_back(points[7] + 0.1 * i * Eigen::Vector3d::UnitZ());
  }
  joints[7] = joints[40] = 3;
  const FiberAssembly fibers(points, {0, 40, 60}, {0.01, 0.02}, {{1, 0}, joints, {}});
  for (const double error : {1e-3, 0.1, 10.0}) {
    const FiberAssembly fewer = select_points(fibers, enough_points({&fibers}, error));
    EXPECT_TRUE(fewer.is_closed(0));
    EXPECT_GE(fewer.given_offsets()[1], 4U);
    EXPECT_EQ(fewer.given_offsets()[2] - fewer.given_offsets()[1], 2U);
    const std::vector<std::int32_t> kept = fewer.topology().joints;
    EXPECT_EQ(std::count(kept.begin(), kept.end(), 3), 2);
  }
}

TEST(Resampling, ABulgeStaysEnclosed) {
  const FiberAssembly fibers({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {0, 3}, {0.1, 0.3, 0.2});
  const FiberAssembly fewer = select_points(fibers, enough_points({&fibers}, 1e-3));
  ASSERT_EQ(fewer.segment_count(), 1U);
  EXPECT_EQ(fewer.segment_radius(0), 0.3);
}

TEST(FrameOrder, TheFirstBlocksAreSpreadAndAllComeOnce) {
  for (const std::size_t count : {1U, 19U, 20U, 21U, 600U, 1234U}) {
    std::vector<int> seen(count, 0);
    for (const FrameBlock& block : spread_blocks(count)) {
      for (std::size_t i = block.begin; i < block.end; ++i) {
        ++seen[i];
      }
    }
    EXPECT_EQ(seen, std::vector<int>(count, 1)) << count;
  }
  const std::vector<FrameBlock> blocks = spread_blocks(640);
  EXPECT_EQ(blocks[0].begin, 0U);
  EXPECT_EQ(blocks[1].begin, 320U);
  EXPECT_EQ(blocks[2].begin, 160U);
}

}  // namespace
}  // namespace fiber::test
