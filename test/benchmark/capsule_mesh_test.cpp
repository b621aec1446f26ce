#include "benchmark/environment/capsule_mesh.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "src/environment/convex_solids.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

TEST(CapsuleMesh, IsAClosedSurfaceOfTheCapsule) {
  for (const double length : {0.0, 0.4}) {
    const CapsuleShape capsule{0.05, length};
    const auto mesh = capsule_mesh(capsule.radius, capsule.length, 5000);
    EXPECT_EQ(mesh->triangles().size(), 5000U);
    EXPECT_TRUE(mesh->is_closed());
    for (const Vector3d& vertex : mesh->vertices()) {
      ASSERT_NEAR(point_distance(capsule, vertex).distance, 0.0, 1e-12);
    }
    const Vector3d centre = Vector3d::Zero();
    EXPECT_LT(mesh->axis_distance(centre, centre, std::numeric_limits<double>::infinity()).distance,
              -0.049);
  }
}

TEST(CapsuleMesh, HasTwiceASquareOfTriangles) {
  EXPECT_EQ(capsule_mesh(0.05, 0.1, 1)->triangles().size(), 18U);
  EXPECT_EQ(capsule_mesh(0.05, 0.1, 40)->triangles().size(), 32U);
  EXPECT_TRUE(capsule_mesh(0.05, 0.1, 1)->is_closed());
}

}  // namespace
}  // namespace fiber::test
