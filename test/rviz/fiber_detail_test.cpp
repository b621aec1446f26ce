#include "src/rviz/fiber_detail.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "test/support/dense_fibers.hpp"

namespace fiber_proximity_rviz {
namespace {

using Eigen::Vector3d;
using fiber::FiberAssembly;
using fiber::test::Random;

/// One colour per fibre, or on some of them another here and there.
std::vector<Color> random_colors(const FiberAssembly& fibers, Random& random) {
  std::vector<Color> colors(fibers.point_count());
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const double share = random.chance(0.5) ? 0.0 : 0.2;
    for (std::uint32_t p = fibers.offsets()[fiber]; p < fibers.offsets()[fiber + 1]; ++p) {
      colors[p] = {static_cast<std::uint8_t>(fiber), 0, 0,
                   static_cast<std::uint8_t>(random.chance(share) ? 1 : 255)};
    }
  }
  return colors;
}

PointRange all_of(const FiberAssembly& fibers, std::size_t fiber) {
  return {fibers.offsets()[fiber], fibers.offsets()[fiber + 1] - 1};
}

std::vector<std::uint32_t> kept_points(const FiberAssembly& fibers, const FiberMesh& mesh,
                                       const PointRange& range, double tolerance) {
  std::vector<std::uint32_t> kept;
  simplify(fibers.points(), mesh.vertices, range, tolerance, kept);
  return kept;
}

/// Nothing but the points between two kept ones is left out, and these lie and look like the line.
void expect_stands_for(const FiberAssembly& fibers, const FiberMesh& mesh,
                       const std::vector<std::uint32_t>& kept, const PointRange& range,
                       double tolerance) {
  ASSERT_GE(kept.size(), 2U);
  ASSERT_EQ(kept.front(), range.first);
  ASSERT_EQ(kept.back(), range.last);
  for (std::size_t i = 0; i + 1 < kept.size(); ++i) {
    ASSERT_LT(kept[i], kept[i + 1]);
    const Vector3d& a = fibers.points()[kept[i]];
    const Vector3d& b = fibers.points()[kept[i + 1]];
    for (std::uint32_t p = kept[i] + 1; p < kept[i + 1]; ++p) {
      const Vector3d& point = fibers.points()[p];
      ASSERT_LE(fiber::segment_distance(point, point, a, b).distance, tolerance + 1e-14);
      for (const std::uint32_t end : {kept[i], kept[i + 1]}) {
        ASSERT_EQ(mesh.vertices[2 * p].color, mesh.vertices[2 * end].color);
        ASSERT_EQ(mesh.vertices[2 * p].offset, mesh.vertices[2 * end].offset);
      }
    }
  }
}

TEST(FiberDetail, WhatIsLeftOutIsWithinTheToleranceOfWhatIsKept) {
  SCOPED_TRACE(fiber::test::seed_message());
  Random random;
  FiberMesher mesher;
  std::size_t left_out = 0;
  for (const fiber::test::AssemblyFamily& family : fiber::test::dense_families()) {
    for (const double tolerance : {0.0, 1e-5, 1e-3, 1e-2, 1.0}) {
      SCOPED_TRACE(family.name + ", tolerance " + std::to_string(tolerance));
      const FiberAssembly fibers = family.make(random);
      const FiberMesh& mesh = mesher.make_ribbons(fibers, random_colors(fibers, random));
      for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
        const PointRange range = all_of(fibers, fiber);
        const std::vector<std::uint32_t> kept = kept_points(fibers, mesh, range, tolerance);
        expect_stands_for(fibers, mesh, kept, range, tolerance);
        const std::size_t count = range.last - range.first + 1;
        left_out += count - kept.size();
        if (tolerance == 0.0) {
          ASSERT_EQ(kept.size(), count);
        }
      }
    }
  }
  fiber::test::expect_enough(left_out, std::size_t{1001});
}

TEST(FiberDetail, ACircleTakesHardlyMoreThanItMust) {
  const std::vector<Vector3d> points = fiber::test::sampled(
      1000, [](double x) { return Vector3d(std::cos(6.28 * x), std::sin(6.28 * x), 0.0); });
  const FiberAssembly fibers(points, {0, 1001}, {0.01});
  FiberMesher mesher;
  const FiberMesh& mesh = mesher.make_ribbons(fibers, std::vector<Color>(1001));
  for (const double tolerance : {1e-4, 1e-3}) {
    const auto kept =
        static_cast<double>(kept_points(fibers, mesh, all_of(fibers, 0), tolerance).size());
    // A chord of a unit circle is 1 − cos(angle / 2) away from it.
    const double fewest = 6.28 / (2.0 * std::acos(1.0 - tolerance));
    EXPECT_GE(kept, fewest);
    EXPECT_LE(kept, 1.25 * fewest + 2.0);
  }
}

FiberChunk thick(double radius) {
  FiberChunk chunk;
  chunk.largest_radius = radius;
  return chunk;
}

TEST(FiberDetail, ToleranceIsThePixelErrorOrUpToHalfOfIt) {
  SCOPED_TRACE(fiber::test::seed_message());
  Random random;
  for (int i = 0; i < 1000; ++i) {
    const double pixel = std::pow(10.0, random.uniform(-12.0, 12.0));
    const auto error = static_cast<float>(std::pow(10.0, random.uniform(-2.0, 2.0)));
    const double tolerance = choose_detail(thick(1.0), pixel, {true, error}).tolerance();
    EXPECT_LE(tolerance, pixel * static_cast<double>(error));
    EXPECT_GT(2.0 * tolerance, pixel * static_cast<double>(error));
  }
  EXPECT_EQ(choose_detail(thick(1.0), 1e-300, {}).tolerance(), 0.0);
  EXPECT_EQ(choose_detail(thick(1.0), std::numeric_limits<double>::min(), {}).tolerance(), 0.0);
  EXPECT_TRUE(std::isfinite(
      choose_detail(thick(1.0), std::numeric_limits<double>::max(), {true, 9.0F}).tolerance()));
}

TEST(FiberDetail, OnlyWhatIsThinnerThanAPixelIsLines) {
  using Kind = Detail::Kind;
  EXPECT_EQ(choose_detail(thick(0.1), 0.19, {}).kind, Kind::ribbons);
  EXPECT_EQ(choose_detail(thick(0.1), 0.21, {}).kind, Kind::lines);
  const Detail all = choose_detail(thick(0.1), 0.21, {false, 0.5F});
  EXPECT_EQ(all.kind, Kind::ribbons);
  EXPECT_EQ(all.tolerance(), 0.0);
}

TEST(FiberDetail, IndicesRunFromPointToPoint) {
  const FiberAssembly fibers({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {7, 7, 7}, {7, 7, 9}},
                             {0, 4, 6}, {0.1});
  FiberMesher mesher;
  const FiberMesh& mesh = mesher.make_ribbons(fibers, std::vector<Color>(6));
  FiberChunk chunk = thick(0.1);
  chunk.ranges = {all_of(fibers, 0), all_of(fibers, 1)};
  const auto indices = [&](Detail::Kind kind, int level) {
    return make_indices(fibers.points(), mesh.vertices, chunk, {kind, level});
  };
  using Indices = std::vector<std::uint32_t>;
  EXPECT_EQ(indices(Detail::Kind::lines, -10), (Indices{0, 4, 4, 6, 8, 10}));
  EXPECT_EQ(indices(Detail::Kind::lines, Detail::finest), (Indices{0, 2, 2, 4, 4, 6, 8, 10}));
  EXPECT_EQ(indices(Detail::Kind::ribbons, -10),
            (Indices{0, 1, 4, 4, 1, 5, 4, 5, 6, 6, 5, 7, 8, 9, 10, 10, 9, 11}));
}

}  // namespace
}  // namespace fiber_proximity_rviz
