#include "src/rviz/view_fit.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "test/support/random.hpp"

namespace fiber_proximity_rviz {
namespace {

using Eigen::Vector3d;

/// Where points are in the picture: from -1 at the left and lower side to 1 at the others.
std::vector<Eigen::Vector2d> project(const std::vector<Vector3d>& points, const OrbitView& view,
                                     const ViewFit& fit) {
  // The camera's axes by rotations, other than in fit_view().
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(view.yaw, Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(-view.pitch, Vector3d::UnitY()))
                                   .toRotationMatrix();
  const Vector3d eye = fit.focal_point + fit.distance * turn.col(0);
  std::vector<Eigen::Vector2d> seen;
  for (const Vector3d& point : points) {
    const Vector3d ray = turn.transpose() * (point - eye);
    EXPECT_LT(ray.x(), 0.0) << "behind the camera";
    seen.emplace_back(ray.y() / -ray.x() / view.tan_half_width,
                      ray.z() / -ray.x() / view.tan_half_height);
  }
  return seen;
}

double reach(const std::vector<Eigen::Vector2d>& seen) {
  double largest = 0.0;
  for (const Eigen::Vector2d& point : seen) {
    largest = std::max(largest, point.cwiseAbs().maxCoeff());
  }
  return largest;
}

TEST(ViewFit, PointsReachOverTheShareOfThePicture) {
  SCOPED_TRACE(fiber::test::seed_message());
  fiber::test::Random random;
  for (int round = 0; round < 200; ++round) {
    const OrbitView view{random.uniform(-M_PI, M_PI), random.uniform(-1.5, 1.5),
                         random.uniform(0.2, 2.0), random.uniform(0.2, 2.0)};
    const double size = std::pow(10.0, random.uniform(-3.0, 3.0));
    const Vector3d place = 100.0 * random.in_cube();
    std::vector<Vector3d> points;
    for (int i = 0; i < 20; ++i) {
      points.push_back(place + size * random.in_cube());
    }
    const double share = random.uniform(0.1, 1.0);
    EXPECT_NEAR(reach(project(points, view, fit_view(points, view, share))), share, 1e-6);
  }
}

TEST(ViewFit, ACablePointingAtTheCameraIsBeforeIt) {
  const std::vector<Vector3d> points{{0, 0, 0}, {1, 0, 0}};
  const OrbitView view;  // from positive x
  const ViewFit fit = fit_view(points, view, 0.5);
  EXPECT_EQ(fit.focal_point, Vector3d(0.5, 0, 0));
  EXPECT_GE(fit.distance, 0.5);
}

TEST(ViewFit, WhatItIsFittedToIsInViewAndWhatGoesAwayIsNot) {
  OrbitView view;
  view.yaw = 4.9;
  view.pitch = 0.68;
  view.tan_half_width = 0.6;
  view.tan_half_height = 0.4;
  const std::vector<Eigen::Vector3d> points{{-0.3, 0, 0.5}, {0.3, 0.1, 0.5}, {0, -0.1, 0.7}};
  const ViewFit fit = fit_view(points, view, 0.65);
  EXPECT_TRUE(is_in_view(points, view, fit, 0.65 + 1e-9));
  EXPECT_FALSE(is_in_view(points, view, fit, 0.64));
  for (const Eigen::Vector3d& away :
       {Eigen::Vector3d(0.4, 0, 0), Eigen::Vector3d(-1.2, 0, 0), Eigen::Vector3d(0, 0, 0.5),
        Eigen::Vector3d(0, 0, -0.5), Eigen::Vector3d(0, -3.0, 3.0)}) {
    std::vector<Eigen::Vector3d> moved = points;
    moved[1] += away;
    EXPECT_FALSE(is_in_view(moved, view, fit, 0.85)) << away.transpose();
  }
}

}  // namespace
}  // namespace fiber_proximity_rviz
