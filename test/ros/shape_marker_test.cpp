#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/environment/convex_solids.hpp"
#include "src/ros/outputs/environment_markers.hpp"
#include "src/ros/outputs/tube_mesh.hpp"
#include "test/environment/random_shapes.hpp"
#include "test/support/random.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using fiber::WorldBox;
using fiber::test::Random;
using visualization_msgs::Marker;

constexpr double pi = 3.14159265358979323846;

const WorldBox& everywhere() {
  static const WorldBox box(Vector3d::Constant(-10.0), Vector3d::Constant(10.0));
  return box;
}

Marker draw(const fiber::Shape& shape, const Isometry3d& pose = Isometry3d::Identity(),
            const WorldBox& around = everywhere()) {
  Marker marker;
  draw_shape(shape, pose, around, marker);
  return marker;
}

Isometry3d pose_of(const Marker& marker) {
  const auto& q = marker.pose.orientation;
  return Eigen::Translation3d(to_vector(marker.pose.position)) *
         Eigen::Quaterniond(q.w, q.x, q.y, q.z);
}

/// Volume a triangle list encloses [m³]; fails if an edge does not join two of its triangles.
double enclosed_volume(const Marker& marker) {
  using Corner = std::tuple<double, double, double>;
  std::map<std::pair<Corner, Corner>, int> edges;
  double volume = 0.0;
  for (std::size_t i = 0; i + 2 < marker.points.size(); i += 3) {
    std::array<Vector3d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = to_vector(marker.points[i + k]);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d& a = corners[k];
      const Vector3d& b = corners[(k + 1) % 3];
      const Corner from(a.x(), a.y(), a.z());
      const Corner to(b.x(), b.y(), b.z());
      ++edges[{from, to}];
      --edges[{to, from}];
    }
    volume += corners[0].dot(corners[1].cross(corners[2])) / 6.0;
  }
  for (const auto& [edge, excess] : edges) {
    EXPECT_EQ(excess, 0);
  }
  return volume;
}

/// The capsule and the cone are inscribed: their corners lie on the surface.
template <class Solid>
void expect_on_surface(const Marker& marker, const Solid& solid) {
  for (const geometry_msgs::Point& point : marker.points) {
    EXPECT_NEAR(point_distance(solid, to_vector(point)).distance, 0.0, 1e-12);
  }
}

TEST(ShapeMarker, BoxesSpheresAndCylindersHaveTheirFullSizesAndTheirPoses) {
  SCOPED_TRACE(fiber::test::seed_message());
  Random random;
  const Isometry3d pose = fiber::test::random_pose(random, 2.0);
  const Marker box = draw(fiber::BoxShape{{1, 2, 3}}, pose);
  EXPECT_EQ(box.type, Marker::CUBE);
  EXPECT_EQ(to_vector(box.scale), Vector3d(1, 2, 3));
  EXPECT_TRUE(pose_of(box).isApprox(pose));
  const Marker sphere = draw(fiber::SphereShape{0.5}, pose);
  EXPECT_EQ(sphere.type, Marker::SPHERE);
  EXPECT_EQ(to_vector(sphere.scale), Vector3d(1, 1, 1));
  const Marker cylinder = draw(fiber::CylinderShape{0.5, 3.0}, pose);
  EXPECT_EQ(cylinder.type, Marker::CYLINDER);
  EXPECT_EQ(to_vector(cylinder.scale), Vector3d(1, 1, 3));
  EXPECT_TRUE(pose_of(cylinder).isApprox(pose));
}

TEST(ShapeMarker, ConesAndCapsulesAreClosedSurfacesInscribedInThem) {
  SCOPED_TRACE(fiber::test::seed_message());
  Random random;
  for (int run = 0; run < 20; ++run) {
    const double radius = random.uniform(0.1, 1.0);
    const double length = random.uniform(0.1, 2.0);
    const fiber::ConeShape cone{radius, length};
    const Marker drawn_cone = draw(cone);
    EXPECT_EQ(drawn_cone.type, Marker::TRIANGLE_LIST);
    EXPECT_EQ(to_vector(drawn_cone.scale), Vector3d(1, 1, 1));
    expect_on_surface(drawn_cone, cone);
    const double cone_volume = pi * radius * radius * length / 3.0;
    EXPECT_LT(enclosed_volume(drawn_cone), cone_volume);
    EXPECT_GT(enclosed_volume(drawn_cone), 0.99 * cone_volume);

    const fiber::CapsuleShape capsule{radius, length};
    const Marker drawn_capsule = draw(capsule);
    expect_on_surface(drawn_capsule, capsule);
    const double capsule_volume = pi * radius * radius * (length + 4.0 / 3.0 * radius);
    EXPECT_LT(enclosed_volume(drawn_capsule), capsule_volume);
    EXPECT_GT(enclosed_volume(drawn_capsule), 0.98 * capsule_volume);
  }
}

TEST(ShapeMarker, WhatHasNoExtentCanStillBeSeen) {
  for (const fiber::Shape& shape :
       std::vector<fiber::Shape>{fiber::BoxShape{}, fiber::SphereShape{}, fiber::CylinderShape{}}) {
    EXPECT_EQ(to_vector(draw(shape).scale), Vector3d::Constant(2.0 * hairline_radius));
  }
  EXPECT_GT(enclosed_volume(draw(fiber::ConeShape{})), 0.0);
  EXPECT_GT(enclosed_volume(draw(fiber::CapsuleShape{})), 0.0);
}

TEST(ShapeMarker, SheetsHaveTheirSurfaceWhereItIsAndCoverWhatIsLookedAt) {
  SCOPED_TRACE(fiber::test::seed_message());
  Random random;
  for (int run = 0; run < 20; ++run) {
    const Isometry3d pose = fiber::test::random_pose(random, 1.0);
    const fiber::HalfSpaceShape half_space{random.direction(), random.uniform(-1.0, 1.0)};
    const fiber::PlaneShape plane{half_space.normal, half_space.offset};
    const Vector3d corner = random.in_cube(2.0);
    const WorldBox around(corner, corner + Vector3d(1, 2, 3));
    const Marker solid = draw(half_space, pose, around);
    const Marker sheet = draw(plane, pose, around);
    ASSERT_EQ(solid.type, Marker::CUBE);
    EXPECT_LT(solid.scale.z, 0.01 * solid.scale.x);
    const auto distance = [&](const Marker& marker, const Vector3d& part) {
      const Vector3d point = pose_of(marker) * part.cwiseProduct(to_vector(marker.scale));
      return point_distance(half_space, pose.inverse() * point).distance;
    };
    for (const double x : {-0.5, 0.5}) {
      EXPECT_NEAR(distance(solid, {x, 0.5, 0.5}), 0.0, 1e-12);
      EXPECT_NEAR(distance(sheet, {x, 0.5, 0.0}), 0.0, 1e-12);
    }
    EXPECT_LT(distance(solid, Vector3d::Zero()), 0.0);
    // The box's shadow on the sheet is within it.
    for (int i = 0; i < 8; ++i) {
      const Vector3d seen =
          pose_of(sheet).inverse() * around.corner(static_cast<WorldBox::CornerType>(i));
      EXPECT_LE(std::abs(seen.x()), 0.5 * sheet.scale.x);
      EXPECT_LE(std::abs(seen.y()), 0.5 * sheet.scale.y);
    }
  }
}

TEST(ShapeMarker, OfMeshesThoseTrianglesThatReachIn) {
  const auto mesh = fiber::test::box_mesh({1, 1, 1}, 4);
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = Vector3d(5, 0, 0);
  const Marker whole = draw(mesh, pose);
  EXPECT_EQ(whole.type, Marker::TRIANGLE_LIST);
  EXPECT_EQ(whole.points.size(), 3 * mesh->triangles().size());
  EXPECT_NEAR(enclosed_volume(whole), 1.0, 1e-12);
  EXPECT_EQ(whole.pose.position.x, 5.0);
  const Marker face = draw(mesh, pose, WorldBox(Vector3d(5.49, -10, -10), Vector3d(6, 10, 10)));
  // The side, and of the four beside it the last row.
  EXPECT_EQ(face.points.size(), 3U * (32 + 4 * 8));
}

TEST(ShapeMarker, GiantMeshesAreTheirBoxes) {
  Random random;
  const auto soup = fiber::test::triangle_soup(random, max_mesh_triangles, 1.0);
  EXPECT_EQ(draw(soup).type, Marker::TRIANGLE_LIST);
  const auto giant = fiber::test::triangle_soup(random, max_mesh_triangles + 1, 1.0);
  const Isometry3d pose = fiber::test::random_pose(random, 1.0);
  const Marker box = draw(giant, pose);
  ASSERT_EQ(box.type, Marker::CUBE);
  EXPECT_TRUE(box.points.empty());
  EXPECT_EQ(to_vector(box.scale), Vector3d(giant->box().sizes()));
  EXPECT_TRUE(pose_of(box).translation().isApprox(pose * giant->box().center()));
}

TEST(ShapeMarker, OfOctreesThoseCellsThatReachIn) {
  const auto octree = fiber::test::octree_of(0.1, {{0.05, 0.05, 0.05}, {0.95, 0.05, 0.05}});
  const Marker both = draw(octree);
  EXPECT_EQ(both.type, Marker::CUBE_LIST);
  EXPECT_EQ(to_vector(both.scale), Vector3d::Constant(octree->resolution()));
  EXPECT_EQ(both.points.size(), 2U);
  const Marker one =
      draw(octree, Isometry3d::Identity(), WorldBox(Vector3d(0.95, 0, 0), Vector3d(2, 1, 1)));
  ASSERT_EQ(one.points.size(), 1U);
  EXPECT_NEAR(one.points.front().x, 0.95, 1e-9);
}

TEST(ShapeMarker, ReachesIntoABoxWhereOneOfItsPointsDoes) {
  SCOPED_TRACE(fiber::test::seed_message());
  Random random;
  int far = 0;
  for (int run = 0; run < 2000; ++run) {
    const Isometry3d pose = fiber::test::random_pose(random, 3.0);
    const Vector3d corner = random.in_cube(3.0);
    const WorldBox box(corner, corner + Vector3d(0.5, 0.6, 0.7));
    const fiber::HalfSpaceShape half_space{random.direction(), random.uniform(-3.0, 3.0)};
    const fiber::PlaneShape plane{half_space.normal, half_space.offset};
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -lowest;
    for (int i = 0; i < 8; ++i) {
      const Vector3d seen = pose.inverse() * box.corner(static_cast<WorldBox::CornerType>(i));
      const double distance = point_distance(half_space, seen).distance;
      lowest = std::min(lowest, distance);
      highest = std::max(highest, distance);
    }
    EXPECT_EQ(reaches_into(box, half_space, pose), lowest <= 0.0);
    EXPECT_EQ(reaches_into(box, plane, pose), lowest <= 0.0 && highest >= 0.0);
    far += lowest > 0.0 ? 1 : 0;
    const fiber::SphereShape sphere{0.5};
    EXPECT_EQ(reaches_into(box, sphere, pose), fiber::world_box(sphere, pose).intersects(box));
  }
  fiber::test::expect_enough(far, 101);
}

}  // namespace
}  // namespace fiber_proximity_ros
