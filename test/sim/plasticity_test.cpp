#include <gtest/gtest.h>

#include <limits>

#include "fiber_proximity/sim/effects.hpp"
#include "test/support/error_of.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

constexpr double wire_radius = 0.01;  // [m]
constexpr double yield_strain = 0.02;
constexpr double yield_curvature = yield_strain / wire_radius;

/// Points on an arc of length 1 with this curvature [1/m].
std::vector<Vector3d> arc(double curvature, int segments) {
  std::vector<Vector3d> points;
  for (int i = 0; i <= segments; ++i) {
    const double angle = curvature * i / segments;
    points.emplace_back(std::sin(angle) / curvature, 0.0, (1.0 - std::cos(angle)) / curvature);
  }
  return points;
}

/// The curvature that stays where a rod that was straight is bent, step by step, to this one.
double remaining(double curvature, double hardening) {
  constexpr int segments = 10;
  Rods rods;
  rods.add(straight(Vector3d::Zero(), Vector3d(1.0, 0.0, 0.0), segments), wire_radius,
           {1.0, 1.0, 0.0, 1.0, 0.0});
  Plasticity plasticity(rods, {yield_strain, hardening});
  constexpr int steps = 7;
  for (int i = 1; i <= steps; ++i) {
    rods.positions = arc(curvature * i / steps, segments);
    plasticity.end_step(rods, {0.0, 1.0});
  }
  for (int i = 2; i < segments; ++i) {
    EXPECT_NEAR(rods.natural_curvatures[i], rods.natural_curvatures[1], 1e-9);
  }
  return rods.natural_curvatures[1];
}

TEST(Plasticity, NothingStaysBelowTheYieldStrain) {
  EXPECT_EQ(remaining(0.99 * yield_curvature, 0.0), 0.0);
}

TEST(Plasticity, WhatExceedsTheYieldStrainStays) {
  // The chords of an arc are shorter than it by a part in 24 n² of its angle's square.
  EXPECT_NEAR(remaining(3.0 * yield_curvature, 0.0), 2.0 * yield_curvature, 0.02);
}

TEST(Plasticity, HardeningKeepsAShareOfThatElastic) {
  // Each step moves the natural curvature by a share of what exceeds the yield: in the limit all.
  const double soft = remaining(3.0 * yield_curvature, 0.0);
  const double hard = remaining(3.0 * yield_curvature, 0.5);
  EXPECT_GT(hard, 0.5 * soft);
  EXPECT_LT(hard, 0.95 * soft);
}

TEST(Plasticity, ABentRodSpringsBackByTheYieldCurvatureAlone) {
  constexpr int segments = 20;
  Rods rods;
  rods.add(straight(Vector3d::Zero(), Vector3d(1.0, 0.0, 0.0), segments), wire_radius,
           {1e4, 1.0, 0.0, 1.0, 0.0});
  Plasticity plasticity(rods, {yield_strain, 0.0});
  rods.positions = arc(2.0 * yield_curvature, segments);
  plasticity.end_step(rods, {0.0, 1.0});
  Stepper stepper(rods, effects(std::make_unique<Stretch>(), std::make_unique<Bend>()), precise());
  settle(stepper);
  const std::vector<Vector3d>& points = stepper.rods().positions;
  for (int i = 1; i < segments; ++i) {
    const Vector3d turn =
        (points[i + 1] - points[i]).normalized() - (points[i] - points[i - 1]).normalized();
    const double curvature = 2.0 * std::asin(0.5 * turn.norm()) * segments;
    EXPECT_NEAR(curvature, yield_curvature, 0.01 * yield_curvature) << "node " << i;
  }
}

TEST(Plasticity, RefusesWhatItCannotUse) {
  Rods rods;
  EXPECT_EQ(error_of([&] {
              Plasticity(rods, {0.0, 0.0});
            }),
            "plasticity: the yield strain is 0.000000, it must be positive and finite");
  EXPECT_EQ(error_of([&] {
              Plasticity(rods, {std::numeric_limits<double>::quiet_NaN(), 0.0});
            }),
            "plasticity: the yield strain is nan, it must be positive and finite");
  EXPECT_EQ(error_of([&] {
              Plasticity(rods, {0.1, 1.0});
            }),
            "plasticity: the hardening is 1.000000, it must be at least 0 and less than 1");
}

}  // namespace
}  // namespace fiber::test
