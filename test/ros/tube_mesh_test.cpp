#include "src/ros/outputs/tube_mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "fiber_proximity/geometry/segment_distance.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;
using fiber::FiberAssembly;

std::vector<Vector3d> mesh_of(const FiberAssembly& fibers, std::uint32_t fiber = 0) {
  std::vector<geometry_msgs::Point> triangles;
  append_tube(fibers, fiber, triangles);
  std::vector<Vector3d> corners;
  corners.reserve(triangles.size());
  for (const geometry_msgs::Point& point : triangles) {
    corners.emplace_back(point.x, point.y, point.z);
  }
  return corners;
}

FiberAssembly chain(const std::vector<Vector3d>& points, double radius) {
  return {points, {0, static_cast<std::uint32_t>(points.size())}, {radius}};
}

/// By segment, of the first fibre [m].
std::vector<double> distances_to_axes(const FiberAssembly& fibers, const Vector3d& corner) {
  std::vector<double> distances;
  for (std::uint32_t p = 0; p + 1 < fibers.offsets()[1]; ++p) {
    const fiber::Capsule capsule = fibers.capsule(p);
    distances.push_back(fiber::segment_distance(corner, corner, capsule.p0, capsule.p1).distance);
  }
  return distances;
}

double distance_to_axis(const FiberAssembly& fibers, const Vector3d& corner) {
  const std::vector<double> distances = distances_to_axes(fibers, corner);
  return *std::min_element(distances.begin(), distances.end());
}

/// Volume inside a closed mesh whose triangles face outwards [m³].
double volume_of(const std::vector<Vector3d>& corners) {
  double volume = 0.0;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    volume += corners[i].dot(corners[i + 1].cross(corners[i + 2])) / 6.0;
  }
  return volume;
}

TEST(TubeMesh, HasOneRingAtAGentleBendAndTwoAtASharpOne) {
  const Vector3d first(1, 0, 0);
  const Vector3d second = Vector3d(1, 0.2, 0).normalized();
  const Vector3d third(0, 0, 1);
  const Vector3d begin(1, 2, 3);
  std::vector<TubeRing> rings;
  sweep_tube(
      chain({begin, begin + first, begin + first + second, begin + first + second + third}, 0.1), 0,
      rings);
  const std::vector<Vector3d> tangents{first, (first + second).normalized(), second, third, third};
  ASSERT_EQ(rings.size(), tangents.size());
  for (std::size_t i = 0; i < rings.size(); ++i) {
    EXPECT_LT((rings[i].tangent - tangents[i]).norm(), 1e-12) << i;
    EXPECT_NEAR(rings[i].normal.dot(tangents[i]), 0.0, 1e-12) << i;
  }
}

TEST(TubeMesh, StraightTubeHasTheExactRadius) {
  const FiberAssembly fibers = chain({{1, 2, 3}, {1.5, 2, 3}, {2, 2, 3}}, 0.25);
  const std::vector<Vector3d> corners = mesh_of(fibers);
  // Two triangles per side and stretch (2 segments, 2 collars of the half spheres), one per side
  // and pole.
  EXPECT_EQ(corners.size(), 3U * tube_sides * (2 * 4 + 2));
  for (const Vector3d& corner : corners) {
    EXPECT_NEAR(distance_to_axis(fibers, corner), 0.25, 1e-12);
  }
}

TEST(TubeMesh, IsClosedAndFacesOutwards) {
  const double radius = 0.1;
  const double length = 2.0;
  const double volume = volume_of(mesh_of(chain({{0, 0, 0}, {1, 0, 0}, {length, 0, 0}}, radius)));
  const double octagon = 2.0 * std::sqrt(2.0) * radius * radius;
  EXPECT_GT(volume, octagon * length);
  EXPECT_LT(volume, M_PI * radius * radius * (length + 4.0 / 3.0 * radius));
}

TEST(TubeMesh, RandomChainsStayInsideTheirCapsulesAndTouchThem) {
  const unsigned seed = 20240611;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (int repeat = 0; repeat < 50; ++repeat) {
    std::vector<Vector3d> points{Vector3d::Zero()};
    for (int i = 0; i < 30; ++i) {
      points.push_back(points.back() + Vector3d(normal(random), normal(random), normal(random)));
    }
    constexpr double radius = 0.01;
    const FiberAssembly fibers = chain(points, radius);
    for (const Vector3d& corner : mesh_of(fibers)) {
      const std::vector<double> distances = distances_to_axes(fibers, corner);
      EXPECT_LE(*std::min_element(distances.begin(), distances.end()), radius * (1.0 + 1e-9));
      // The one ring between two segments of a gentle bend is as much as 3 % closer to them.
      EXPECT_TRUE(std::any_of(distances.begin(), distances.end(), [](double distance) {
        return distance > 0.97 * radius && distance < radius * (1.0 + 1e-9);
      }));
    }
  }
}

TEST(TubeMesh, SegmentsKeepTheirOwnRadii) {
  const FiberAssembly fibers({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {0, 3}, {0.1, 0.1, 0.3});
  double thin = 0.0;
  double thick = 0.0;
  for (const Vector3d& corner : mesh_of(fibers)) {
    double& widest = corner.x() < 0.999 ? thin : thick;
    widest = std::max(widest, std::hypot(corner.y(), corner.z()));
  }
  EXPECT_NEAR(thin, 0.1, 1e-12);
  EXPECT_NEAR(thick, 0.3, 1e-12);
}

TEST(TubeMesh, MeshesTheFiberAskedForAndAppends) {
  const FiberAssembly fibers({{0, 0, 0}, {1, 0, 0}, {5, 0, 0}, {6, 0, 0}}, {0, 2, 4}, {0.1});
  std::vector<geometry_msgs::Point> triangles(3);
  append_tube(fibers, 1, triangles);
  ASSERT_GT(triangles.size(), 3U);
  EXPECT_EQ(triangles[0].x, 0.0);
  for (std::size_t i = 3; i < triangles.size(); ++i) {
    EXPECT_GE(triangles[i].x, 4.9 - 1e-12);
  }
}

TEST(TubeMesh, FramesDoNotTwist) {
  // On a planar curve the frame's normal keeps its angle to the plane: each line of corners stays
  // at its height.
  std::vector<Vector3d> points;
  const Vector3d across = Vector3d(1, 2, 3).normalized();
  const Vector3d x = across.unitOrthogonal();
  const Vector3d y = across.cross(x);
  for (int i = 0; i <= 40; ++i) {
    points.emplace_back(std::cos(0.1 * i) * x + std::sin(0.1 * i) * y);
  }
  std::vector<double> heights;
  for (const Vector3d& corner : mesh_of(chain(points, 0.05))) {
    heights.push_back(std::round(1e9 * corner.dot(across)) / 1e9);
  }
  std::sort(heights.begin(), heights.end());
  heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
  // At most one height per side of the tube and of the collars, and the poles.
  EXPECT_LE(heights.size(), 2U * tube_sides + 1);
}

TEST(TubeMesh, DegenerateChainsGiveFiniteCorners) {
  const std::vector<std::vector<Vector3d>> chains{
      {{1, 1, 1}, {1, 1, 1}},                                   // all points coincide
      {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {2, 0, 0}},  // some do
      {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0}},             // folded back
      {{0, 0, 0}, {0, 0, 1}, {0, 0, 0}},
      {{0, 0, 0}, {1e-300, 0, 0}, {1e-300, 1e-310, 0}},
      {{-1e150, 0, 0}, {1e150, 1e150, 0}, {1e150, -1e150, 0}},
  };
  for (std::size_t i = 0; i < chains.size(); ++i) {
    SCOPED_TRACE(testing::Message() << "chain " << i);
    const FiberAssembly fibers = chain(chains[i], 0.01);
    for (const Vector3d& corner : mesh_of(fibers)) {
      ASSERT_TRUE(corner.allFinite()) << corner.transpose();
    }
  }
  for (std::size_t i = 0; i < 4; ++i) {
    SCOPED_TRACE(testing::Message() << "chain " << i);
    const FiberAssembly fibers = chain(chains[i], 0.01);
    for (const Vector3d& corner : mesh_of(fibers)) {
      EXPECT_NEAR(distance_to_axis(fibers, corner), 0.01, 1e-12);
    }
  }
}

TEST(TubeMesh, RadiusZeroIsDrawnAsHairline) {
  const FiberAssembly fibers = chain({{0, 0, 0}, {1, 0, 0}}, 0.0);
  for (const Vector3d& corner : mesh_of(fibers)) {
    EXPECT_NEAR(distance_to_axis(fibers, corner), hairline_radius, 1e-15);
  }
}

}  // namespace
}  // namespace fiber_proximity_ros
