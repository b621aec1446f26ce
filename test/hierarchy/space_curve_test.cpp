#include "src/hierarchy/space_curve.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>

#include "test/support/assemblies.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

std::vector<std::uint64_t> keys_of(const std::vector<Vector3d>& points,
                                   const std::vector<std::uint32_t>& first_points) {
  std::vector<std::uint64_t> keys(first_points.size());
  SpaceCurve(points).key_segments(points, first_points.data(), first_points.size(), keys.data());
  return keys;
}

/// What no other curve that halves cubes has: it goes from every cell to one of its neighbours.
TEST(SpaceCurve, GoesFromCellToNeighbour) {
  constexpr int edge = 16;
  std::vector<Vector3d> points;
  std::vector<std::uint32_t> first_points;
  for (int x = 0; x < edge; ++x) {
    for (int y = 0; y < edge; ++y) {
      for (int z = 0; z < edge; ++z) {
        first_points.push_back(static_cast<std::uint32_t>(points.size()));
        points.insert(points.end(), 2, Vector3d(x, y, z));
      }
    }
  }
  std::vector<std::uint64_t> keys = keys_of(points, first_points);
  std::sort(keys.begin(), keys.end());
  const auto cell = [&](std::uint64_t key) { return points[static_cast<std::uint32_t>(key)]; };
  for (std::size_t i = 1; i < keys.size(); ++i) {
    EXPECT_NE(keys[i] >> 32U, keys[i - 1] >> 32U) << "one position for two cells";
    EXPECT_EQ((cell(keys[i]) - cell(keys[i - 1])).lpNorm<1>(), 1.0) << "between " << i - 1;
  }
}

TEST(SpaceCurve, GivesTheSameKeysWithEveryInstructionSet) {
  SCOPED_TRACE(seed_message());
  Random random;
  const std::vector<Vector3d> points = random_walk(random, 1000, 0.1);
  std::vector<std::uint32_t> first_points;
  for (std::uint32_t point = 0; point + 1 < points.size(); ++point) {
    first_points.push_back(point);
  }
  const std::vector<std::uint64_t> expected = keys_of(points, first_points);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    EXPECT_EQ(keys_of(points, first_points), expected) << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(SpaceCurve, TakesPointsAllInOnePlace) {
  const std::vector<Vector3d> points(3, Vector3d(1.0, 2.0, 3.0));
  const std::vector<std::uint64_t> keys = keys_of(points, {1, 0});
  EXPECT_EQ(keys[0] & 0xFFFF'FFFFU, 1U);
  EXPECT_EQ(keys[1] & 0xFFFF'FFFFU, 0U);
  EXPECT_EQ(keys[0] >> 32U, keys[1] >> 32U);
}

}  // namespace
}  // namespace fiber::test
