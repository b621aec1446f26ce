#include "benchmark/swaying.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "fiber_proximity/scenes/scene.hpp"
#include "test/support/random.hpp"

namespace fiber::test {
namespace {

constexpr double step = 0.003;  // [m]

std::vector<double> distances(const std::vector<Eigen::Vector3d>& a,
                              const std::vector<Eigen::Vector3d>& b) {
  std::vector<double> result;
  for (std::size_t i = 0; i < a.size(); ++i) {
    result.push_back((b[i] - a[i]).norm());
  }
  return result;
}

FiberAssembly small_scene() {
  SceneOptions options;
  options.scale = 0.002;
  return make_scene("soup", options)(0);
}

TEST(Swaying, MovesEveryPointByTheStepInEveryFrame) {
  SCOPED_TRACE(seed_message());
  const FiberAssembly fibers = small_scene();
  Swaying swaying(fibers, step, static_cast<std::uint64_t>(Random().integer(0, 1000)));
  for (std::uint32_t frame = 0; frame < 500; ++frame) {
    const std::vector<Eigen::Vector3d> before = swaying.points(frame);
    for (const double moved : distances(before, swaying.points(frame + 1))) {
      ASSERT_NEAR(moved, step, 1e-9 * step) << "frame " << frame;
    }
  }
}

TEST(Swaying, KeepsTheSceneInShape) {
  SCOPED_TRACE(seed_message());
  const FiberAssembly fibers = small_scene();
  const double length = mean_segment_length(fibers);
  Swaying swaying(fibers, 0.02 * length, static_cast<std::uint64_t>(Random().integer(0, 1000)));
  for (std::uint32_t frame = 0; frame < 1000; frame += 7) {
    const std::vector<double> moved = distances(fibers.points(), swaying.points(frame));
    ASSERT_LT(*std::max_element(moved.begin(), moved.end()), length) << "frame " << frame;
    FiberAssembly swayed = fibers;
    swayed.update_points(swaying.points(frame));
    ASSERT_NEAR(mean_segment_length(swayed), length, 0.02 * length) << "frame " << frame;
  }
}

TEST(Swaying, IsTheSameForASeedAndAnotherForAnother) {
  const FiberAssembly fibers = small_scene();
  Swaying one(fibers, step, 1);
  EXPECT_EQ(one.points(5), Swaying(fibers, step, 1).points(5));
  EXPECT_NE(one.points(5), Swaying(fibers, step, 2).points(5));
}

TEST(Swaying, DoesNotMoveAllPointsAlike) {
  const FiberAssembly fibers = small_scene();
  Swaying swaying(fibers, step, 1);
  const std::vector<Eigen::Vector3d> points = swaying.points(0);
  double least = 1.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d a = points[0] - fibers.points()[0];
    const Eigen::Vector3d b = points[i] - fibers.points()[i];
    least = std::min(least, a.normalized().dot(b.normalized()));
  }
  EXPECT_LT(least, 0.9);
}

TEST(Swaying, MovesFibersThatLieTogetherApart) {
  const FiberAssembly fibers({{0, 0, 0}, {1e-6, 0, 0}, {0, 0, 0}, {1e-6, 0, 0}}, {0, 2, 4}, {0.1});
  Swaying swaying(fibers, step, 1);
  const std::vector<Eigen::Vector3d>& points = swaying.points(10);
  const double apart = (points[2] - points[0]).norm();
  EXPECT_GT(apart, 0.01 * step);
  EXPECT_LT(apart, 10.0 * step);
}

TEST(Swaying, MovesAsManyFibersAsAskedFor) {
  std::vector<Eigen::Vector3d> places;
  std::vector<std::uint32_t> offsets{0};
  for (std::uint32_t fiber = 0; fiber < 20; ++fiber) {
    places.emplace_back(fiber, 0, 0);
    places.emplace_back(fiber, 1, 0);
    offsets.push_back(2 * (fiber + 1));
  }
  const FiberAssembly fibers(places, offsets, {0.1});
  for (const std::size_t moving : {0U, 1U, 5U, 20U}) {
    Swaying swaying(fibers, step, 1, static_cast<double>(moving) / 20.0);
    const std::vector<Eigen::Vector3d> before = swaying.points(0);
    const std::vector<Eigen::Vector3d>& after = swaying.points(1);
    std::size_t moved = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      moved += before[i] == after[i] ? 0 : 1;
    }
    EXPECT_EQ(moved, 2 * moving);
  }
}

TEST(Swaying, TakesFibersInOnePointAndNone) {
  const FiberAssembly none;
  EXPECT_EQ(mean_segment_length(none), 0.0);
  EXPECT_TRUE(Swaying(none, step, 1).points(3).empty());
  const FiberAssembly collapsed({{1, 2, 3}, {1, 2, 3}}, {0, 2}, {0.1});
  EXPECT_EQ(mean_segment_length(collapsed), 0.0);
  Swaying swaying(collapsed, 0.0, 1);
  EXPECT_EQ(swaying.points(3), collapsed.points());
}

TEST(MeanSegmentLength, LeavesOutTheGapsBetweenFibers) {
  const FiberAssembly fibers({{0, 0, 0}, {1, 0, 0}, {9, 0, 0}, {9, 3, 0}, {9, 3, 5}}, {0, 2, 5},
                             {0.1});
  EXPECT_DOUBLE_EQ(mean_segment_length(fibers), 3.0);
}

}  // namespace
}  // namespace fiber::test
