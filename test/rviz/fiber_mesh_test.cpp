#include "src/rviz/fiber_mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "src/rviz/fiber_detail.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/random.hpp"

namespace fiber_proximity_rviz {
namespace {

using Eigen::Vector3d;
using fiber::FiberAssembly;
using fiber::test::Random;

constexpr Color red{255, 0, 0, 255};

std::vector<Color> all_red(const FiberAssembly& fibers) {
  return std::vector<Color>(fibers.point_count(), red);
}

/// A colour that tells which point it is of.
std::vector<Color> numbered(const FiberAssembly& fibers) {
  std::vector<Color> colors;
  for (std::size_t i = 0; i < fibers.point_count(); ++i) {
    colors.push_back(
        {static_cast<std::uint8_t>(i % 256), static_cast<std::uint8_t>(i / 256), 7, 9});
  }
  return colors;
}

Vector3d to_vector(const std::array<float, 3>& floats) {
  return {static_cast<double>(floats[0]), static_cast<double>(floats[1]),
          static_cast<double>(floats[2])};
}

Vector3d position(const FiberMesh& mesh, std::size_t vertex) {
  return mesh.origin + to_vector(mesh.vertices[vertex].position);
}

FiberAssembly chain(const std::vector<Vector3d>& points, double radius) {
  return {points, {0, static_cast<std::uint32_t>(points.size())}, {radius}};
}

FiberAssembly random_fibers(Random& random) {
  fiber::test::AssemblyBuilder builder;
  for (int fiber = 0; fiber < 20; ++fiber) {
    builder.add_fiber(fiber::test::random_walk(random, 2 + fiber, 0.1));
  }
  return builder.build({0.01});
}

/// Signed volume inside all triangles, which face outwards [m³].
double volume_of(const FiberMesh& mesh) {
  double volume = 0.0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Vector3d a = position(mesh, mesh.indices[i]);
    const Vector3d b = position(mesh, mesh.indices[i + 1]);
    const Vector3d c = position(mesh, mesh.indices[i + 2]);
    volume += a.dot(b.cross(c)) / 6.0;
  }
  return volume;
}

void expect_sound(const FiberMesh& mesh) {
  for (const std::uint32_t index : mesh.indices) {
    ASSERT_LT(index, mesh.vertices.size());
  }
  for (const MeshVertex& vertex : mesh.vertices) {
    ASSERT_TRUE(to_vector(vertex.position).allFinite());
    ASSERT_TRUE(to_vector(vertex.direction).allFinite());
    ASSERT_TRUE(mesh.box.contains(to_vector(vertex.position).cast<float>()));
  }
}

/// Every edge of a closed surface is run through once in each direction.
void expect_closed(const FiberMesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      edges.emplace_back(mesh.indices[i + k], mesh.indices[i + (k + 1) % 3]);
    }
  }
  std::sort(edges.begin(), edges.end());
  EXPECT_EQ(std::adjacent_find(edges.begin(), edges.end()), edges.end());
  for (const auto& [from, to] : edges) {
    ASSERT_TRUE(std::binary_search(edges.begin(), edges.end(), std::pair(to, from)));
  }
}

TEST(FiberMesh, RibbonsHaveTwoEdgesAlongTheAxis) {
  Random random;
  SCOPED_TRACE(fiber::test::seed_message());
  const FiberAssembly fibers = random_fibers(random);
  FiberMesher mesher;
  const FiberMesh& mesh = mesher.make_ribbons(fibers, numbered(fibers));
  expect_sound(mesh);
  EXPECT_EQ(mesh.kind, FiberMesh::Kind::ribbons);
  ASSERT_EQ(mesh.vertices.size(), 2 * fibers.point_count());
  const std::vector<Color> colors = numbered(fibers);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    EXPECT_LT((position(mesh, i) - fibers.points()[i / 2]).norm(), 1e-5);
    EXPECT_EQ(mesh.vertices[i].color, colors[i / 2]);
    EXPECT_NEAR(to_vector(mesh.vertices[i].direction).norm(), 1.0, 1e-6);
    EXPECT_FLOAT_EQ(mesh.vertices[i].offset, i % 2 == 0 ? 0.01F : -0.01F);
  }
}

/// Where the edges of ribbons lie in the plane, seen from above: left of the way is the tangent
/// turned by a quarter.
std::vector<Vector3d> seen_from_above(const FiberMesh& mesh) {
  std::vector<Vector3d> edges;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vector3d tangent = to_vector(mesh.vertices[i].direction);
    edges.push_back(position(mesh, i) + static_cast<double>(mesh.vertices[i].offset) *
                                            Vector3d::UnitZ().cross(tangent));
  }
  return edges;
}

TEST(FiberMesh, RibbonsCoverTheirSegmentsAndNothingElse) {
  // Two straight fibres of three and one segments: their areas are lengths times widths.
  const FiberAssembly fibers({{0, 0, 0}, {1, 0, 0}, {1.5, 0, 0}, {4, 0, 0}, {9, 5, 0}, {9, 7, 0}},
                             {0, 4, 6}, {0.1, 0.3});
  FiberMesher mesher;
  const FiberMesh& mesh = mesher.make_ribbons(fibers, all_red(fibers));
  FiberChunk all;
  all.ranges = {{0, 3}, {4, 5}};
  const std::vector<std::uint32_t> indices =
      make_indices(fibers.points(), mesh.vertices, all, Detail());
  ASSERT_EQ(indices.size(), 6 * fibers.segment_count());
  const std::vector<Vector3d> edges = seen_from_above(mesh);
  double area = 0.0;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const Vector3d& a = edges[indices[i]];
    const Vector3d& b = edges[indices[i + 1]];
    const Vector3d& c = edges[indices[i + 2]];
    const double triangle = 0.5 * (b - a).cross(c - a).z();
    EXPECT_GT(triangle, 0.0);  // all turn the same way
    area += triangle;
  }
  EXPECT_NEAR(area, 4.0 * 0.2 + 2.0 * 0.6, 1e-5);
  EXPECT_TRUE(mesh.box.contains(Eigen::Vector3f(0.0F, -0.1F, 0.0F)));
  EXPECT_TRUE(mesh.box.contains(Eigen::Vector3f(9.3F, 6.0F, 0.0F)));
}

TEST(FiberMesh, RibbonsHaveTheTangentOfTheirNeighbours) {
  const FiberAssembly fibers({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {5, 5, 5}, {5, 5, 6}}, {0, 3, 5},
                             {0.1});
  FiberMesher mesher;
  const FiberMesh& mesh = mesher.make_ribbons(fibers, all_red(fibers));
  const std::vector<Vector3d> expected{
      {1, 0, 0}, Vector3d(1, 1, 0).normalized(), {0, 1, 0}, {0, 0, 1}, {0, 0, 1}};
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    EXPECT_LT((to_vector(mesh.vertices[i].direction) - expected[i / 2]).norm(), 1e-6) << i;
  }
}

TEST(FiberMesh, RibbonsOfRadiusZeroKeepTheirSides) {
  const FiberAssembly fibers = chain({{0, 0, 0}, {1, 0, 0}}, 0.0);
  FiberMesher mesher;
  const FiberMesh& mesh = mesher.make_ribbons(fibers, all_red(fibers));
  EXPECT_GT(mesh.vertices[0].offset, 0.0F);
  EXPECT_LT(mesh.vertices[1].offset, 0.0F);
}

TEST(FiberMesh, StraightTubeIsAPrismWithRoundEnds) {
  const Vector3d a(1, 2, 3);
  const Vector3d b(1, 2, 7);
  const double radius = 0.5;
  const FiberAssembly fibers = chain({a, b}, radius);
  for (const int sides : {3, 6, 8, 32}) {
    SCOPED_TRACE(testing::Message() << sides << " sides");
    FiberMesher mesher;
    const FiberMesh& mesh = mesher.make_tubes(fibers, all_red(fibers), sides);
    expect_sound(mesh);
    expect_closed(mesh);
    EXPECT_EQ(mesh.kind, FiberMesh::Kind::tubes);
    const auto n = static_cast<std::size_t>(sides);
    EXPECT_EQ(mesh.vertices.size(), 4 * n + 2);  // two rings, two collars, two poles
    EXPECT_EQ(mesh.indices.size(),
              3 * (2 * 4 * n));  // three rows of quads, two of triangles at the poles
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      const Vector3d p = position(mesh, i);
      const Vector3d nearest(1, 2, std::clamp(p.z(), 3.0, 7.0));
      EXPECT_NEAR((p - nearest).norm(), radius, 1e-6);
      // Everywhere on a capsule the normal points away from the axis.
      EXPECT_LT((to_vector(mesh.vertices[i].direction) - (p - nearest) / radius).norm(), 1e-5);
    }
    // A prism over a regular polygon, and at each end a frustum and a pyramid of it.
    const double polygon = 0.5 * sides * std::sin(2.0 * M_PI / sides);
    const double d = std::sqrt(0.5);
    const double end = d / 3.0 * (1.0 + d + d * d) + (1.0 - d) / 3.0 * d * d;
    EXPECT_NEAR(volume_of(mesh),
                polygon * radius * radius * 4.0 + 2.0 * polygon * end * std::pow(radius, 3), 1e-5);
  }
}

TEST(FiberMesh, RandomTubesAreClosedSkinsOfTheirCapsules) {
  Random random;
  SCOPED_TRACE(fiber::test::seed_message());
  const FiberAssembly fibers = random_fibers(random);
  FiberMesher mesher;
  const FiberMesh& mesh = mesher.make_tubes(fibers, numbered(fibers), 5);
  expect_sound(mesh);
  expect_closed(mesh);
  const std::vector<Color> colors = numbered(fibers);
  std::size_t vertex = 0;
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const std::uint32_t begin = fibers.offsets()[fiber];
    const std::uint32_t end = fibers.offsets()[fiber + 1];
    std::uint32_t point = begin;
    // A fibre's vertices follow one another, from its first point to its last.
    while (vertex < mesh.vertices.size() && mesh.vertices[vertex].color[2] == 7) {
      const Color& color = mesh.vertices[vertex].color;
      const auto owner = static_cast<std::uint32_t>(color[0] + 256 * color[1]);
      if (owner >= end) {
        break;
      }
      ASSERT_GE(owner, point);
      point = owner;
      const Vector3d p = position(mesh, vertex);
      const Vector3d outward = p - fibers.points()[point];
      EXPECT_NEAR(outward.norm(), 0.01, 1e-6);
      const Vector3d normal = to_vector(mesh.vertices[vertex].direction);
      EXPECT_NEAR(normal.norm(), 1.0, 1e-6);
      EXPECT_GT(normal.dot(outward), 0.009);
      ++vertex;
    }
    EXPECT_EQ(point, end - 1);
  }
  EXPECT_EQ(vertex, mesh.vertices.size());
}

TEST(FiberMesh, DegenerateChainsGiveFiniteVertices) {
  const std::vector<std::vector<Vector3d>> chains{
      {{1, 1, 1}, {1, 1, 1}},
      {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {2, 0, 0}},
      {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0}},
      {{0, 0, 0}, {1e-300, 0, 0}, {1e-300, 1e-310, 0}},
      {{-1e15, 0, 0}, {1e15, 1e15, 0}, {1e15, -1e15, 0}},
  };
  FiberMesher mesher;
  for (std::size_t i = 0; i < chains.size(); ++i) {
    SCOPED_TRACE(testing::Message() << "chain " << i);
    for (const double radius : {0.0, 0.01, 1e15}) {
      const FiberAssembly fibers = chain(chains[i], radius);
      expect_sound(mesher.make_ribbons(fibers, all_red(fibers)));
      expect_sound(mesher.make_tubes(fibers, all_red(fibers), 6));
      expect_closed(mesher.make_tubes(fibers, all_red(fibers), 6));
    }
  }
}

TEST(FiberMesh, FarFromTheFrameThereIsNoJitter) {
  // A float at 6e6 m is half a metre coarse.
  const Vector3d far(6e6, -6e6, 100.0);
  std::vector<Vector3d> points;
  for (int i = 0; i < 50; ++i) {
    points.emplace_back(far + Vector3d(0.01 * i, 0.0, 0.0));
  }
  const FiberAssembly fibers = chain(points, 0.002);
  FiberMesher mesher;
  const FiberMesh ribbons = mesher.make_ribbons(fibers, all_red(fibers));
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LT((position(ribbons, 2 * i) - points[i]).norm(), 1e-6);
  }
  const FiberMesh& tubes = mesher.make_tubes(fibers, all_red(fibers), 8);
  for (std::size_t i = 0; i < tubes.vertices.size(); ++i) {
    const Vector3d p = position(tubes, i);
    EXPECT_NEAR(fiber::segment_distance(p, p, points.front(), points.back()).distance, 0.002, 1e-6);
  }
}

TEST(FiberMesh, NothingGivesNothing) {
  const FiberAssembly none;
  FiberMesher mesher;
  EXPECT_TRUE(mesher.make_ribbons(none, {}).vertices.empty());
  EXPECT_TRUE(mesher.make_tubes(none, {}, 8).indices.empty());
  EXPECT_TRUE(mesher.make_tubes(none, {}, 8).box.isEmpty());
}

TEST(FiberMesh, MemoryOfAnEarlierMeshDoesNotShow) {
  Random random;
  SCOPED_TRACE(fiber::test::seed_message());
  const FiberAssembly large = random_fibers(random);
  const FiberAssembly small = chain({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, 0.1);
  FiberMesher used;
  used.make_tubes(large, all_red(large), 8);
  used.make_ribbons(large, all_red(large));
  const FiberMesh again = used.make_tubes(small, all_red(small), 8);
  FiberMesher fresh;
  const FiberMesh& expected = fresh.make_tubes(small, all_red(small), 8);
  EXPECT_EQ(again.indices, expected.indices);
  ASSERT_EQ(again.vertices.size(), expected.vertices.size());
  for (std::size_t i = 0; i < again.vertices.size(); ++i) {
    EXPECT_EQ(again.vertices[i].position, expected.vertices[i].position);
  }
  EXPECT_TRUE(again.box.isApprox(expected.box));
}

TEST(FiberMesh, WhatCannotBeDrawnIsRefused) {
  FiberMesher mesher;
  const FiberAssembly far = chain({{0, 0, 0}, {0, 1.1e15, 0}}, 0.1);
  EXPECT_THROW(mesher.make_ribbons(far, all_red(far)), std::invalid_argument);
  EXPECT_THROW(mesher.make_tubes(far, all_red(far), 8), std::invalid_argument);
  const FiberAssembly thick = chain({{0, 0, 0}, {0, 1, 0}}, 1.1e15);
  EXPECT_THROW(mesher.make_tubes(thick, all_red(thick), 8), std::invalid_argument);
  EXPECT_THROW(mesher.make_ribbons(thick, all_red(thick)), std::invalid_argument);

  const std::vector<Vector3d> points(FiberMesher::max_vertices / 32 + 1, Vector3d::Zero());
  const FiberAssembly large = chain(points, 0.1);
  EXPECT_THROW(mesher.make_tubes(large, all_red(large), 32), std::invalid_argument);
  EXPECT_NO_THROW(mesher.make_ribbons(large, all_red(large)));
}

}  // namespace
}  // namespace fiber_proximity_rviz
