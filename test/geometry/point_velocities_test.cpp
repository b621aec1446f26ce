#include "src/geometry/point_velocities.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> found_in(const PointVelocities& frames) {
  std::vector<Vector3d> velocities;
  frames.find(velocities);
  return velocities;
}

TEST(PointVelocities, AreThoseOfPointsThatKeepThem) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < rounds(100); ++round) {
    const double now = 1.7e9;  // [s] as of a clock
    const Vector3d places[] = {random.in_cube(), 1e3 * random.in_cube()};
    const Vector3d ways[] = {random.in_cube(), Vector3d::Zero()};
    PointVelocities frames(5);
    double time = 0.0;
    for (int i = 0; i < 5; ++i) {
      time += 0x1p-6 * static_cast<double>(random.integer(1, 8));
      frames.add(now + time, {places[0] + time * ways[0], places[1] + time * ways[1]});
    }
    const std::vector<Vector3d> velocities = found_in(frames);
    ASSERT_EQ(velocities.size(), 2U);
    EXPECT_LT((velocities[0] - ways[0]).norm(), 1e-13);
    EXPECT_LT((velocities[1] - ways[1]).norm(), 1e-10);
    EXPECT_GT(frames.duration(), 0.0);
  }
}

/// Against the normal equations of place and velocity.
TEST(PointVelocities, HaveTheLeastSumOfSquares) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < rounds(100); ++round) {
    const auto count = static_cast<Eigen::Index>(random.integer(2, 9));
    PointVelocities frames(static_cast<std::size_t>(count));
    Eigen::MatrixX2d lines(count, 2);
    Eigen::MatrixX3d places(count, 3);
    double time = 0.0;
    for (Eigen::Index i = 0; i < count; ++i) {
      time += random.uniform(0.01, 0.1);
      places.row(i) = random.in_cube();
      lines.row(i) << 1.0, time;
      frames.add(time, {places.row(i)});
    }
    const Eigen::Matrix<double, 2, 3> best =
        (lines.transpose() * lines).ldlt().solve(lines.transpose() * places);
    const Vector3d expected = best.row(1);
    EXPECT_LT((found_in(frames).front() - expected).norm(), 1e-8 * (1.0 + expected.norm()));
  }
}

TEST(PointVelocities, RestOnTheNewestFramesAlone) {
  PointVelocities frames(3);
  frames.add(0.0, {{5.0, 0.0, 0.0}});
  frames.add(1.0, {{0.0, 0.0, 0.0}});
  frames.add(2.0, {{2.0, 0.0, 0.0}});
  frames.add(3.0, {{4.0, 0.0, 0.0}});
  EXPECT_EQ(frames.frame_count(), 3U);
  EXPECT_EQ(frames.duration(), 2.0);
  EXPECT_EQ(found_in(frames).front(), Vector3d(2.0, 0.0, 0.0));
}

TEST(PointVelocities, BeginAnewWithWhatDoesNotGoOn) {
  PointVelocities frames(3);
  EXPECT_TRUE(found_in(frames).empty());
  EXPECT_EQ(frames.duration(), 0.0);
  const auto expect_new = [&](double time, const std::vector<Vector3d>& points) {
    frames.add(time, points);
    EXPECT_EQ(frames.frame_count(), 1U);
    EXPECT_EQ(found_in(frames), std::vector<Vector3d>(points.size(), Vector3d::Zero()));
  };
  expect_new(1.0, {{0.0, 0.0, 0.0}});
  expect_new(1.0, {{1.0, 0.0, 0.0}});
  expect_new(0.5, {{2.0, 0.0, 0.0}});
  frames.add(0.75, {{2.5, 0.0, 0.0}});
  EXPECT_EQ(found_in(frames).front(), Vector3d(2.0, 0.0, 0.0));
  expect_new(1.0, {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}});
  frames.forget();
  EXPECT_EQ(frames.frame_count(), 0U);
}

}  // namespace
}  // namespace fiber::test
