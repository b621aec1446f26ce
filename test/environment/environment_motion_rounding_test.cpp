// Fibres that only just touch what they pass: no contact is missed for a rounding.
#include <gtest/gtest.h>

#include <cmath>

#include "test/environment/motion_scene.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;
using WideVector = Eigen::Matrix<long double, 3, 1>;

WideVector wide(const Vector3d& v) { return v.cast<long double>(); }

/// A straight fibre that passes a ball far from the origin, in the frame of an object that is
/// turned; the margin is what is left between them, rounded up.
TEST(EnvironmentMotionRounding, WhatOnlyJustTouchesIsFound) {
  SCOPED_TRACE(seed_message());
  Random random;
  constexpr double ball_radius = 0.1;
  constexpr double radius = 0.01;
  for (int round = 0; round < rounds(1000); ++round) {
    const Eigen::Isometry3d pose = random_pose(random, 1e3);
    const Eigen::Isometry3d in_object = random_pose(random, 1.0);
    const EnvironmentObject object{"ball", pose, {{SphereShape{ball_radius}, in_object}}};
    const Eigen::Matrix<long double, 3, 3> turn = pose.linear().cast<long double>();
    const WideVector center = wide(pose.translation()) + turn * wide(in_object.translation());
    const Vector3d along = random.direction();
    const Vector3d way = random.direction();
    const Vector3d up = along.cross(way).normalized();
    const Vector3d middle = center.cast<double>() + random.uniform(0.3, 1.0) * up;
    const std::vector<Vector3d> before{middle - 0.5 * along - 0.5 * way,
                                       middle + 0.5 * along - 0.5 * way};
    const std::vector<Vector3d> after{middle - 0.5 * along + 0.5 * way,
                                      middle + 0.5 * along + 0.5 * way};
    // A point of the fibre at a time, about the nearest one: the ball is no further away than it.
    const WideVector from_corner = center - wide(before[0]);
    const long double part = from_corner.dot(wide(along));
    const long double other = along.dot(way);
    const long double across = from_corner.dot(wide(way));
    const long double determinant = 1.0L - other * other;
    const long double s = (part - other * across) / determinant;
    const long double time = (across - other * part) / determinant;
    const WideVector start = (1.0L - time) * wide(before[0]) + time * wide(after[0]);
    const WideVector end = (1.0L - time) * wide(before[1]) + time * wide(after[1]);
    const long double distance = ((1.0L - s) * start + s * end - center).norm();
    MotionOptions options;
    options.tolerance = 0.0;
    options.margin = std::nextafter(static_cast<double>(distance - ball_radius - radius), 2.0);
    const MotionResult result = ask({object}, cable(before, radius), cable(after, radius), options);
    ASSERT_EQ(result.contacts.size(), 1U) << round;
  }
}

}  // namespace
}  // namespace fiber::test
