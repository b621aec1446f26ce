#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "src/environment/convex_solids.hpp"
#include "src/environment/triangle_distance.hpp"
#include "test/environment/random_shapes.hpp"
#include "test/support/error_of.hpp"
#include "test/support/not_finite.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

template <class Shape>
constexpr bool is_solid = !std::is_same_v<Shape, std::shared_ptr<const TriangleMesh>> &&
                          !std::is_same_v<Shape, std::shared_ptr<const OccupancyOctree>>;

/// A segment, some of them of no length or through the origin along an axis.
std::pair<Vector3d, Vector3d> random_segment(Random& random, double extent) {
  const Vector3d p0 = random.in_cube(1.5 * extent);
  if (random.chance(0.1)) {
    return {p0, p0};
  }
  if (random.chance(0.1)) {
    const Vector3d axis = Vector3d::Unit(random.integer(0, 2));
    return {-extent * axis, random.uniform(-1.0, 2.0) * extent * axis};
  }
  return {p0, p0 + random.in_cube(random.chance(0.5) ? extent : 0.1 * extent)};
}

/// As near a minimum as sampling comes, and the lower bound within rounding of it.
TEST(AxisDistance, OfSolidsIsTheMinimumAndProvesIt) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const double extent : {1e-9, 1.0, 1e6}) {
    for (int round = 0; round < 300; ++round) {
      const auto [p0, p1] = random_segment(random, extent);
      const Vector3d begin = p0;
      const Vector3d along = p1 - p0;
      for (const Shape& shape : random_shapes(random, extent)) {
        std::visit(
            [&](const auto& solid) {
              if constexpr (is_solid<std::decay_t<decltype(solid)>>) {
                const AxisDistance found = axis_distance(solid, begin, begin + along);
                const double rounding = 1e-14 * extent;
                ASSERT_LE(found.lower, found.distance);
                ASSERT_LE(found.distance - found.lower, rounding) << shape.index();
                ASSERT_EQ(found.distance, point_distance(solid, begin + found.s * along).distance);
                for (int i = 0; i <= 50; ++i) {
                  const double value = point_distance(solid, begin + i / 50.0 * along).distance;
                  ASSERT_GE(value, found.lower - rounding) << shape.index() << " at " << i;
                }
              }
            },
            shape);
      }
    }
  }
}

TEST(AxisDistance, OfASphereIsThatOfItsCentre) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < 1000; ++round) {
    const auto [p0, p1] = random_segment(random, 1.0);
    const double radius = random.uniform(0.0, 1.0);
    const SegmentDistance centre = segment_distance(p0, p1, Vector3d::Zero(), Vector3d::Zero());
    EXPECT_NEAR(axis_distance(SphereShape{radius}, p0, p1).distance, centre.distance - radius,
                1e-14);
  }
}

TEST(AxisDistance, OfACapsuleIsThatOfItsSegment) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < 1000; ++round) {
    const auto [p0, p1] = random_segment(random, 1.0);
    const CapsuleShape capsule{random.uniform(0.0, 1.0), random.uniform(0.0, 2.0)};
    const Vector3d half(0.0, 0.0, capsule.length / 2.0);
    EXPECT_NEAR(axis_distance(capsule, p0, p1).distance,
                segment_distance(p0, p1, -half, half).distance - capsule.radius, 1e-14);
  }
}

/// The distance a mesh has must be that of the nearest of all its triangles.
TEST(AxisDistance, OfAnOpenMeshIsThatOfTheNearestTriangle) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const double extent : {1e-6, 1.0, 1e6}) {
    for (int round = 0; round < 200; ++round) {
      const auto mesh = triangle_soup(random, 50, extent);
      const auto [p0, p1] = random_segment(random, extent);
      double least = infinity;
      for (const TriangleMesh::Triangle& triangle : mesh->triangles()) {
        const TriangleCorners corners{mesh->vertices()[triangle[0]], mesh->vertices()[triangle[1]],
                                      mesh->vertices()[triangle[2]]};
        least = std::min(least, segment_triangle(p0, p1, corners).distance);
      }
      EXPECT_FALSE(mesh->is_closed());
      EXPECT_EQ(mesh->axis_distance(p0, p1, infinity).distance, least);
      EXPECT_EQ(mesh->axis_distance(p0, p1, least).distance, least);
      EXPECT_EQ(mesh->axis_distance(p0, p1, std::nextafter(least, -1.0)).distance, infinity);
    }
  }
}

TEST(AxisDistance, OfATriangleDoesNotDependOnWhichCornerIsFirst) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < 1000; ++round) {
    const auto [p0, p1] = random_segment(random, 1.0);
    const TriangleCorners corners{random.in_cube(1.0), random.in_cube(1.0), random.in_cube(1.0)};
    const double distance = segment_triangle(p0, p1, corners).distance;
    for (const TriangleCorners& other : {TriangleCorners{corners[1], corners[2], corners[0]},
                                         TriangleCorners{corners[2], corners[0], corners[1]}}) {
      ASSERT_NEAR(segment_triangle(p0, p1, other).distance, distance, 1e-12);
    }
  }
}

/// A box and a mesh of its surface are the same solid.
TEST(AxisDistance, OfAClosedMeshIsThatOfItsSolid) {
  SCOPED_TRACE(seed_message());
  Random random;
  int inside = 0;
  for (int round = 0; round < 2000; ++round) {
    const Vector3d size = Vector3d(0.2, 0.2, 0.2) + random.in_cube(0.1);
    const auto mesh = box_mesh(size, random.integer(1, 3));
    ASSERT_TRUE(mesh->is_closed());
    const auto [p0, p1] = random_segment(random, 0.3);
    const AxisDistance solid = axis_distance(BoxShape{size}, p0, p1);
    const AxisDistance found = mesh->axis_distance(p0, p1, infinity);
    EXPECT_LE(found.lower, solid.distance + 1e-14);
    EXPECT_GE(found.distance, solid.distance - 1e-14);
    if (solid.distance > 0.0) {
      EXPECT_NEAR(found.distance, solid.distance, 1e-14);
      EXPECT_NEAR(found.gradient.dot(solid.gradient), 1.0, 1e-6);
    } else {
      const double known = std::max(-solid.distance, (p1 - p0).norm()) / 16.0;
      EXPECT_LE(found.distance - found.lower, 1.1 * known);
      ++inside;
    }
  }
  expect_enough(inside, 51);
}

/// Which way round the triangles are listed, and whether they share vertices, does not matter.
TEST(AxisDistance, OfAClosedMeshDoesNotDependOnItsListing) {
  const std::vector<Vector3d> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<TriangleMesh::Triangle> outwards{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  std::vector<TriangleMesh::Triangle> inwards = outwards;
  for (TriangleMesh::Triangle& triangle : inwards) {
    std::swap(triangle[1], triangle[2]);
  }
  const Vector3d centre(0.2, 0.2, 0.2);
  for (const auto& triangles : {outwards, inwards}) {
    const TriangleMesh mesh(corners, triangles);
    EXPECT_TRUE(mesh.is_closed());
    EXPECT_NEAR(mesh.axis_distance(centre, centre, infinity).distance, -0.2, 1e-15);
    EXPECT_NEAR(mesh.axis_distance(2 * centre, 2 * centre, infinity).distance, 0.2 / std::sqrt(3.0),
                1e-15);
  }
  EXPECT_FALSE(TriangleMesh(corners, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}}).is_closed());
  EXPECT_FALSE(TriangleMesh(corners, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}}).is_closed());
}

/// A tetrahedron a, b, c, d whose edge b–c is split, so that slivers of two faces meet in a and d.
TriangleMesh tetrahedron_of_slivers(const std::vector<Vector3d>& corners, std::uint32_t slivers) {
  std::vector<Vector3d> vertices = corners;
  std::vector<TriangleMesh::Triangle> triangles{{0, 1, 3}, {0, 3, 2}};
  std::uint32_t last = 1;
  for (std::uint32_t i = 1; i <= slivers; ++i) {
    std::uint32_t next = 2;
    if (i < slivers) {
      next = static_cast<std::uint32_t>(vertices.size());
      const double part = static_cast<double>(i) / slivers;
      vertices.emplace_back(corners[1] + part * (corners[2] - corners[1]));
    }
    triangles.push_back({0, next, last});
    triangles.push_back({3, last, next});
    last = next;
  }
  return {vertices, triangles};
}

/// Near sharp edges and corners the normal of the nearest triangle alone would mistake the side.
TEST(AxisDistance, OfAClosedMeshKnowsItsInsideAtEdgesAndCorners) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < 300; ++round) {
    std::vector<Vector3d> corners(4);
    for (Vector3d& corner : corners) {
      corner = random.in_cube();
    }
    const TriangleMesh mesh = tetrahedron_of_slivers(corners, 8);
    ASSERT_TRUE(mesh.is_closed());
    Eigen::Matrix3d edges;
    edges << corners[1] - corners[0], corners[2] - corners[0], corners[3] - corners[0];
    for (int i = 0; i < 50; ++i) {
      const Vector3d point = corners[static_cast<std::size_t>(random.integer(0, 3))] +
                             random.in_cube(random.chance(0.5) ? 0.1 : 1.0);
      const Vector3d weights = edges.fullPivLu().solve(point - corners[0]);
      const double inside = std::min(weights.minCoeff(), 1.0 - weights.sum());
      if (std::abs(inside) > 1e-6) {
        EXPECT_EQ(mesh.axis_distance(point, point, infinity).distance<0.0, inside> 0.0);
      }
    }
  }
}

/// Deep inside nothing of the surface may be within the bound.
TEST(AxisDistance, OfAClosedMeshIsFoundWhateverTheBound) {
  const auto mesh = box_mesh({2, 2, 2}, 2);
  EXPECT_NEAR(mesh->axis_distance({0, 0, 0}, {0.01, 0, 0}, 0.001).distance, -1.0, 1e-15);
  EXPECT_EQ(mesh->axis_distance({3, 0, 0}, {3.01, 0, 0}, 0.001).distance, infinity);
}

TEST(AxisDistance, OfAnOctreeIsThatOfTheNearestCell) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const double extent : {1e-6, 1.0, 1e3}) {
    for (int round = 0; round < 200; ++round) {
      const auto octree = random_octree(random, 50, extent);
      const auto [p0, p1] = random_segment(random, extent);
      double least = infinity;
      for (const Vector3d& centre : octree->centres()) {
        const BoxShape cell{Vector3d::Constant(octree->resolution())};
        least = std::min(least, axis_distance(cell, p0 - centre, p1 - centre).distance);
      }
      EXPECT_NEAR(octree->axis_distance(p0, p1, infinity).distance, least, 1e-14 * extent);
      EXPECT_EQ(octree->axis_distance(p0, p1, least - 1e-9 * extent).distance, infinity);
    }
  }
}

TEST(OccupancyOctree, HoldsTheCellsOfItsPoints) {
  const auto octree = octree_of(0.1, {{0.05, 0.05, 0.05}, {0.06, 0.01, 0.09}, {0.15, 0.05, 0.05}});
  EXPECT_EQ(octree->centres().size(), 2U);
  EXPECT_LT(octree->box().min().norm(), 1e-12);
  EXPECT_TRUE(octree->box().max().isApprox(Vector3d(0.2, 0.1, 0.1), 1e-12));
  EXPECT_FALSE(OccupancyOctree::cell_at(0.1, {nan, 0, 0}));
  EXPECT_FALSE(OccupancyOctree::cell_at(0.1, {1e6, 0, 0}));
  EXPECT_EQ(OccupancyOctree(0.1, {}).axis_distance({0, 0, 0}, {1, 0, 0}, infinity).distance,
            infinity);
  EXPECT_THROW(OccupancyOctree(0.0, {}), std::invalid_argument);
  EXPECT_THROW(OccupancyOctree(nan, {}), std::invalid_argument);
}

TEST(TriangleMesh, RefusesWhatIsNoMesh) {
  const std::vector<Vector3d> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const auto refusal = [](const std::vector<Vector3d>& vertices,
                          const std::vector<TriangleMesh::Triangle>& triangles) {
    return error_of([&] { const TriangleMesh mesh(vertices, triangles); });
  };
  EXPECT_EQ(refusal(corners, {{0, 1, 2}}), "no error");
  EXPECT_EQ(refusal(corners, {{0, 1, 2}, {0, 1, 3}}),
            "triangle 1 of the mesh has vertex 3, there are 3");
  EXPECT_NE(refusal({{0, 0, 0}, {1, 0, std::nan("")}, {0, 1, 0}}, {{0, 1, 2}})
                .find("vertex 1 of the mesh: coordinates must be finite"),
            std::string::npos);
  EXPECT_NE(refusal(corners, {}).find("has 0 triangles"), std::string::npos);
  EXPECT_NE(refusal(corners, std::vector<TriangleMesh::Triangle>(1'000'001, {0, 1, 2}))
                .find("at most 1000000"),
            std::string::npos);
}

}  // namespace
}  // namespace fiber::test
