#include "src/ros/environment/cloud_cells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "test/support/error_of.hpp"
#include "test/support/not_finite.hpp"
#include "test/support/random.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using fiber::test::error_of;
using Points = std::vector<Vector3d>;

using fiber::test::nan;
const Isometry3d here = Isometry3d::Identity();

/// Cells that hold points, by their indices.
using Cells = std::set<std::tuple<long, long, long>>;

Cells cells_of(const Points& points, double resolution) {
  Cells cells;
  for (const Vector3d& point : points) {
    const auto index = [&](double x) { return std::lround(std::floor(x / resolution)); };
    cells.emplace(index(point.x()), index(point.y()), index(point.z()));
  }
  return cells;
}

Cells cells_of(const CloudCells& cloud, double resolution) {
  const auto octree = cloud.octree();
  return octree == nullptr ? Cells() : cells_of(octree->centres(), resolution);
}

CloudOptions options(double resolution, double decay = 0.0) {
  CloudOptions options;
  options.resolution = resolution;
  options.decay = decay;
  return options;
}

TEST(CloudCells, TheCellsAreThoseThatHoldPoints) {
  SCOPED_TRACE(fiber::test::seed_message());
  fiber::test::Random random;
  for (const double resolution : {0.02, 0.1, 1.0 / 3.0}) {
    CloudCells cloud(options(resolution));
    const Isometry3d pose = Eigen::Translation3d(random.in_cube()) *
                            Eigen::AngleAxisd(random.uniform(0.0, 6.0), random.direction());
    Points seen;
    Points points;
    for (int i = 0; i < 2000; ++i) {
      seen.push_back(random.in_cube());
      points.push_back(pose * seen.back());
    }
    EXPECT_EQ(cloud.add(seen, pose, 1.0).points, seen.size());
    EXPECT_EQ(cells_of(cloud, resolution), cells_of(points, resolution));
    EXPECT_EQ(cloud.octree()->centres().size(), cells_of(points, resolution).size());
  }
}

TEST(CloudCells, EveryPointIsAccountedFor) {
  CloudOptions boxed = options(0.5);
  boxed.box = {Vector3d(-1, -1, -1), Vector3d(1e9, 1, 1)};
  CloudCells cloud(boxed);
  const Isometry3d pose(Eigen::Translation3d(0, 0, -5));
  const CloudCounts counts = cloud.add(
      {{0, 0, 5}, {nan, 0, 5}, {0, nan, nan}, {0, 0, 0}, {0, -2, 5}, {1e6, 0, 5}, {0, 0, 5.1}},
      pose, 1.0);
  EXPECT_EQ(counts.points, 7U);
  EXPECT_EQ(counts.not_finite, 2U);
  EXPECT_EQ(counts.outside_box, 2U);
  EXPECT_EQ(counts.too_far, 1U);
  EXPECT_EQ(cloud.octree()->centres().size(), 1U);
}

TEST(CloudCells, TheOutermostCellsAreStillInTheOctree) {
  CloudCells cloud(options(1.0));
  const Points outermost{{-32767.5, 0, 0}, {32767.5, 0, 0}};
  EXPECT_EQ(cloud.add(outermost, here, 1.0).too_far, 0U);
  EXPECT_EQ(cloud.octree()->centres().size(), 2U);
  EXPECT_EQ(cloud.add({{32768.5, 0, 0}, {-32768.5, 0, 0}}, here, 2.0).too_far, 2U);
  EXPECT_EQ(cloud.octree(), nullptr);
}

TEST(CloudCells, WithoutDecayOnlyTheNewestCloudCounts) {
  CloudCells cloud(options(1.0));
  cloud.add({{0.5, 0, 0}}, here, 1.0);
  cloud.add({{1.5, 0, 0}}, here, 1.0);
  EXPECT_EQ(cells_of(cloud, 1.0), (Cells{{1, 0, 0}}));
  cloud.add({}, here, 2.0);
  EXPECT_EQ(cloud.octree(), nullptr);
}

TEST(CloudCells, CellsStayAsLongAsTheyWereSeenWithinTheDecay) {
  CloudCells cloud(options(1.0, 2.0));
  cloud.add({{0.5, 0, 0}, {1.5, 0, 0}}, here, 10.0);
  cloud.add({{1.5, 0, 0}}, here, 11.0);
  cloud.add({{2.5, 0, 0}}, here, 12.0);
  EXPECT_EQ(cells_of(cloud, 1.0), (Cells{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
  cloud.add({}, here, 12.5);
  EXPECT_EQ(cells_of(cloud, 1.0), (Cells{{1, 0, 0}, {2, 0, 0}}));
  // Another camera's cloud comes a little late: it counts, and makes nothing older.
  cloud.add({{1.5, 0, 0}, {3.5, 0, 0}}, here, 10.6);
  EXPECT_EQ(cells_of(cloud, 1.0), (Cells{{1, 0, 0}, {2, 0, 0}, {3, 0, 0}}));
  cloud.add({}, here, 13.0);
  EXPECT_EQ(cells_of(cloud, 1.0), (Cells{{1, 0, 0}, {2, 0, 0}}));
}

TEST(CloudCells, WhenTimeStartsAgainSoDoTheCells) {
  CloudCells cloud(options(1.0, 2.0));
  cloud.add({{0.5, 0, 0}}, here, 100.0);
  cloud.add({{1.5, 0, 0}}, here, 1.0);
  EXPECT_EQ(cells_of(cloud, 1.0), (Cells{{1, 0, 0}}));
}

TEST(CloudCells, BadOptionsAreRefused) {
  EXPECT_EQ(error_of([] { CloudCells cells(options(0.0)); }),
            "resolution of the cloud is 0 m, it must be positive and finite");
  EXPECT_EQ(error_of([] { CloudCells cells(options(nan)); }),
            "resolution of the cloud is nan m, it must be positive and finite");
  EXPECT_EQ(error_of([] { CloudCells cells(options(1.0, -1.0)); }),
            "decay of the cloud is -1 s, it must be at least 0 and finite");
  CloudOptions inverted = options(1.0);
  inverted.box = {Vector3d(0, 0, 1), Vector3d(1, 1, 0)};
  EXPECT_EQ(error_of([&] { CloudCells cells(inverted); }),
            "box of the cloud goes from (0 0 1) to (1 1 0), the minimum must be at most the "
            "maximum");
}

}  // namespace
}  // namespace fiber_proximity_ros
