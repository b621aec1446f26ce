#include "src/accuracy/noise.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "test/support/random.hpp"

namespace fiber::test {
namespace {

/// As good as normal, of unit variance.
double normal(Random& random) {
  double sum = 0.0;
  for (int i = 0; i < 12; ++i) {
    sum += random.uniform(-0.5, 0.5);
  }
  return sum;
}

/// A cable that sways by 0.1 m, a turn in 3 s at 30 frames a second, tracked with this noise [m].
std::vector<FiberFrame> swaying(std::size_t count, double noise) {
  Random random;
  std::vector<FiberFrame> frames;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2.0 * M_PI * static_cast<double>(i) / 90.0;
    std::vector<Eigen::Vector3d> points;
    for (int k = 0; k < 12; ++k) {
      points.emplace_back(0.05 * k, 0.1 * std::sin(angle + 0.3 * k), 0.1 * std::cos(angle));
      points.back() += noise * Eigen::Vector3d(normal(random), normal(random), normal(random));
    }
    frames.push_back({static_cast<std::int64_t>(i), {points, {0, 12}, {0.005}}, {}});
  }
  return frames;
}

TEST(Noise, WhatWasAddedIsFound) {
  for (const double noise : {1e-4, 1e-3, 5e-3}) {
    const TrackNoise found = estimate_noise(swaying(300, noise));
    ASSERT_TRUE(found.noise);
    EXPECT_NEAR(*found.noise, noise, 0.2 * noise);
  }
}

TEST(Noise, ASmoothMotionHasNone) {
  const TrackNoise found = estimate_noise(swaying(300, 0.0));
  ASSERT_TRUE(found.noise);
  EXPECT_LT(*found.noise, 1e-6);
  EXPECT_NEAR(found.step, 0.1 * 2.0 * M_PI / 90.0, 2e-3);
}

TEST(Noise, FramesThatAreMissingOrOfOtherPointsAreLeftOut) {
  std::vector<FiberFrame> frames = swaying(300, 1e-3);
  frames.erase(frames.begin() + 100, frames.begin() + 140);
  frames[50].fibers = {{{0, 0, 0}, {1, 0, 0}}, {0, 2}, {0.005}};
  const TrackNoise found = estimate_noise(frames);
  ASSERT_TRUE(found.noise);
  EXPECT_NEAR(*found.noise, 1e-3, 2e-4);
}

TEST(Noise, OfTooFewFramesNothingIsTold) {
  const TrackNoise one = estimate_noise(swaying(1, 1e-3));
  EXPECT_FALSE(one.noise);
  EXPECT_EQ(one.reason, "there are fewer than three frames");
  EXPECT_EQ(one.step, 0.0);
  std::vector<FiberFrame> frames = swaying(20, 1e-3);
  for (std::size_t i = 1; i < frames.size(); i += 2) {
    frames[i].fibers = {{{0, 0, 0}, {1, 0, 0}}, {0, 2}, {0.005}};
  }
  const TrackNoise other = estimate_noise(frames);
  EXPECT_FALSE(other.noise);
  EXPECT_EQ(other.reason, "too few frames in a row have the same points");
}

}  // namespace
}  // namespace fiber::test
