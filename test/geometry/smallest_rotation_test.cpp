#include "src/geometry/smallest_rotation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "test/support/random.hpp"

namespace fiber::test {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Angle between two directions of unit length, exact for small ones and near π, too.
double angle_between(const Vector3d& u, const Vector3d& v) {
  return 2.0 * std::atan2((u - v).norm(), (u + v).norm());
}

void expect_smallest(const Vector3d& from, const Vector3d& to) {
  SCOPED_TRACE(testing::Message() << from.transpose() << " to " << to.transpose());
  const Quaterniond rotation = smallest_rotation(from, to);
  const Vector3d u = from.stableNormalized().normalized();
  const Vector3d v = to.stableNormalized().normalized();
  EXPECT_NEAR(rotation.norm(), 1.0, 1e-15);
  EXPECT_LE((rotation * u - v).norm(), 1e-14);
  const double angle = 2.0 * std::atan2(rotation.vec().norm(), rotation.w());
  EXPECT_NEAR(angle, angle_between(u, v), 1e-14);
}

TEST(SmallestRotation, TurnsOneDirectionIntoTheOther) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int i = 0; i < 1000; ++i) {
    const Vector3d from = random.direction();
    // From the same direction over all angles to the opposite one, and as near to them as can be.
    const double offset = std::pow(10.0, random.uniform(-20.0, 1.0));
    for (const double sign : {1.0, -1.0}) {
      expect_smallest(from, sign * from + offset * random.direction());
    }
    expect_smallest(1e-200 * from, 1e150 * random.direction());
  }
}

TEST(SmallestRotation, OfEqualDirectionsIsNone) {
  EXPECT_EQ(smallest_rotation(Vector3d::UnitX(), 3.0 * Vector3d::UnitX()).coeffs(),
            Quaterniond::Identity().coeffs());
}

TEST(SmallestRotation, OfOppositeDirectionsIsHalfATurn) {
  for (int axis = 0; axis < 3; ++axis) {
    expect_smallest(Vector3d::Unit(axis), -Vector3d::Unit(axis));
  }
}

}  // namespace
}  // namespace fiber::test
