#include <gtest/gtest.h>

#include <cmath>

#include "src/environment/convex_solids.hpp"
#include "test/environment/random_shapes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

// Which points are in a solid, by its definition.
bool is_inside(const BoxShape& box, const Vector3d& p) {
  return (p.cwiseAbs().array() <= box.size.array() / 2.0).all();
}
bool is_inside(const SphereShape& sphere, const Vector3d& p) {
  return p.squaredNorm() <= sphere.radius * sphere.radius;
}
bool is_inside(const CylinderShape& cylinder, const Vector3d& p) {
  return p.head<2>().norm() <= cylinder.radius && std::abs(p.z()) <= cylinder.height / 2.0;
}
bool is_inside(const ConeShape& cone, const Vector3d& p) {
  const double part = 0.5 - p.z() / cone.height;  // 0 at the apex, 1 at the base
  return part >= 0.0 && part <= 1.0 && p.head<2>().norm() <= part * cone.radius;
}
bool is_inside(const CapsuleShape& capsule, const Vector3d& p) {
  const double beyond = std::max(std::abs(p.z()) - capsule.length / 2.0, 0.0);
  return std::hypot(p.x(), p.y(), beyond) <= capsule.radius;
}

template <class Solid>
class PointDistanceTest : public testing::Test {
 protected:
  static Solid random_solid(Random& random, double extent) {
    for (const Shape& shape : random_shapes(random, extent)) {
      if (std::holds_alternative<Solid>(shape)) {
        return std::get<Solid>(shape);
      }
    }
    throw std::logic_error("no such shape");
  }
};

using Solids = testing::Types<BoxShape, SphereShape, CylinderShape, ConeShape, CapsuleShape>;
TYPED_TEST_SUITE(PointDistanceTest, Solids);

/// A step of the distance along the gradient leads to the surface, and no surface is nearer: the
/// distance is no larger than it says, and no smaller. All these solids hold the origin.
TYPED_TEST(PointDistanceTest, IsThatOfTheSurface) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const double extent : {1e-9, 1.0, 1e6}) {
    for (int round = 0; round < 300; ++round) {
      const TypeParam solid = this->random_solid(random, extent);
      const Vector3d point = random.in_cube(1.5 * extent);
      const PointDistance found = point_distance(solid, point);
      const double little = 1e-9 * extent;
      ASSERT_EQ(found.distance <= 0.0, is_inside(solid, point)) << point.transpose();
      ASSERT_NEAR(found.gradient.norm(), 1.0, 1e-12);
      const Vector3d surface = point - found.distance * found.gradient;
      ASSERT_TRUE(is_inside(solid, (1.0 - 1e-9) * surface)) << point.transpose();
      ASSERT_FALSE(is_inside(solid, (1.0 + 1e-9) * surface)) << point.transpose();
      // Nothing of the other kind is nearer.
      for (int i = 0; i < 30; ++i) {
        const Vector3d near =
            point + (std::abs(found.distance) - little) * random.uniform(0, 1) * random.direction();
        if (std::abs(found.distance) > little) {
          ASSERT_EQ(is_inside(solid, near), found.distance < 0.0) << point.transpose();
        }
      }
    }
  }
}

/// f(q) >= f(p) + gradient·(q − p): convex, and what axis_distance() rests on.
TEST(PointDistance, HasASubgradientEverywhere) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < 1000; ++round) {
    // On symmetry axes, edges and centres there is more than one nearest point.
    const Vector3d on_grid(random.integer(-1, 1), random.integer(-1, 1), random.integer(-1, 1));
    const Vector3d p = random.chance(0.5) ? Vector3d(0.5 * on_grid) : random.in_cube();
    const Vector3d q = random.in_cube(2.0);
    const auto check = [&](const auto& solid) {
      const PointDistance at_p = point_distance(solid, p);
      const PointDistance at_q = point_distance(solid, q);
      ASSERT_GE(at_q.distance, at_p.distance + at_p.gradient.dot(q - p) - 1e-14)
          << p.transpose() << " / " << q.transpose();
    };
    check(BoxShape{Vector3d::Ones()});
    check(SphereShape{0.5});
    check(CylinderShape{0.5, 1.0});
    check(ConeShape{0.5, 1.0});
    check(CapsuleShape{0.5, 1.0});
    check(HalfSpaceShape{random.direction(), 0.5});
    check(PlaneShape{Vector3d::UnitZ(), 0.5});
    check(BoxShape{Vector3d::Zero()});
    check(ConeShape{0.0, 1.0});
    check(ConeShape{1.0, 0.0});
    check(CylinderShape{0.0, 0.0});
  }
}

TEST(PointDistance, OfSheets) {
  const HalfSpaceShape half_space{Vector3d::UnitZ(), 2.0};
  EXPECT_EQ(point_distance(half_space, {5, 5, 3}).distance, 1.0);
  EXPECT_EQ(point_distance(half_space, {5, 5, 1}).distance, -1.0);
  const PlaneShape plane{Vector3d::UnitZ(), 2.0};
  EXPECT_EQ(point_distance(plane, {5, 5, 1}).distance, 1.0);
  EXPECT_EQ(point_distance(plane, {5, 5, 1}).gradient, Vector3d(-Vector3d::UnitZ()));
}

}  // namespace
}  // namespace fiber::test
