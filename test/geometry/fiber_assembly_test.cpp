#include "fiber_proximity/geometry/fiber_assembly.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "test/support/error_of.hpp"
#include "test/support/not_finite.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

using test::error_of;
using test::infinity;
using test::nan;

const std::vector<Vector3d> five_points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}};

std::string error_of_assembly(const std::vector<Vector3d>& points,
                              const std::vector<std::uint32_t>& offsets,
                              const std::vector<double>& radii) {
  return error_of([&] { FiberAssembly(points, offsets, radii); });
}

TEST(FiberAssembly, KnowsItsFibersAndSegments) {
  const FiberAssembly fibers(five_points, {0, 3, 5}, {0.1});
  EXPECT_EQ(fibers.fiber_count(), 2U);
  EXPECT_EQ(fibers.point_count(), 5U);
  EXPECT_EQ(fibers.segment_count(), 3U);
  EXPECT_EQ(fibers.segment_id(1).fiber, 0U);
  EXPECT_EQ(fibers.segment_id(1).segment, 1U);
  EXPECT_EQ(fibers.segment_id(3).fiber, 1U);
  EXPECT_EQ(fibers.segment_id(3).segment, 0U);
  EXPECT_EQ(fibers.capsule(3).p1, Vector3d(1, 1, 0));
  // The first point after a fibre that is shorter than most.
  const FiberAssembly uneven(five_points, {0, 2, 5}, {0.1});
  EXPECT_EQ(uneven.segment_id(2).fiber, 1U);
  EXPECT_EQ(uneven.segment_id(2).segment, 0U);
}

TEST(FiberAssembly, OfNothingIsEmpty) {
  EXPECT_EQ(FiberAssembly().segment_count(), 0U);
  EXPECT_EQ(FiberAssembly({}, {0}, {}).fiber_count(), 0U);
}

TEST(FiberAssembly, TakesOneRadiusOnePerFiberOrOnePerPoint) {
  EXPECT_EQ(FiberAssembly(five_points, {0, 3, 5}, {0.1}).segment_radius(3), 0.1);
  EXPECT_EQ(FiberAssembly(five_points, {0, 3, 5}, {0.1, 0.2}).segment_radius(1), 0.1);
  EXPECT_EQ(FiberAssembly(five_points, {0, 3, 5}, {0.1, 0.2}).segment_radius(3), 0.2);
}

TEST(FiberAssembly, KnowsTheRadiusAtAPointAsItWasGiven) {
  const auto expect_radii = [](const FiberAssembly& fibers, RadiusPer how,
                               const std::vector<double>& expected) {
    EXPECT_EQ(fibers.radius_per(), how);
    for (std::size_t point = 0; point < expected.size(); ++point) {
      EXPECT_EQ(fibers.radius_at(point < 3 ? 0 : 1, point), expected[point]) << "point " << point;
    }
  };
  FiberAssembly fibers(five_points, {0, 3, 5}, {1, 2, 3, 4, 5});
  expect_radii(fibers, RadiusPer::POINT, {1, 2, 3, 4, 5});
  expect_radii({five_points, {0, 3, 5}, {1, 2}}, RadiusPer::FIBER, {1, 1, 1, 2, 2});
  expect_radii({five_points, {0, 3, 5}, {7}}, RadiusPer::ASSEMBLY, {7, 7, 7, 7, 7});
  expect_radii({five_points, {0, 5}, {7}}, RadiusPer::ASSEMBLY, {7});
  fibers.assign_segments(five_points, {0, 3, 5}, {6});
  expect_radii(fibers, RadiusPer::ASSEMBLY, {6, 6, 6, 6, 6});
  fibers.assign_segments(five_points, {0, 3, 5}, {1, 3, 0, 2, 0});
  expect_radii(fibers, RadiusPer::POINT, {1, 3, 0, 2, 0});
}

TEST(FiberAssembly, TakesOneRadiusPerSegmentWithNewFibers) {
  FiberAssembly fibers({{7, 7, 7}, {8, 8, 8}}, {0, 2}, {9.0});
  fibers.assign_segments(five_points, {0, 3, 5}, {1, 3, 0, 2, 0});
  EXPECT_EQ(fibers.points(), five_points);
  EXPECT_EQ(fibers.offsets(), (std::vector<std::uint32_t>{0, 3, 5}));
  EXPECT_EQ(fibers.segment_radius(0), 1.0);
  EXPECT_EQ(fibers.segment_radius(1), 3.0);
  EXPECT_EQ(fibers.segment_radius(3), 2.0);
  EXPECT_EQ(fibers.largest_radius(), 3.0);
  const auto error_of_segments = [&](const std::vector<std::uint32_t>& offsets,
                                     const std::vector<double>& radii) {
    return error_of([&] { fibers.assign_segments(five_points, offsets, radii); });
  };
  EXPECT_EQ(error_of_segments({0, 3, 5}, {1, 1}),
            "2 radii of segments for 5 points; give 1 or one per point");
  EXPECT_EQ(error_of_segments({0, 3, 5}, {1, -1, 0, 2, 0}).rfind("fibre 0, point 1: the radius", 0),
            0U);
  EXPECT_EQ(error_of_segments({0, 3}, {1, 1, 0, 2, 0}),
            "the last offset is 3, but there are 5 points");
  EXPECT_EQ(fibers.segment_radius(1), 3.0) << "what was refused changes nothing";
  fibers.assign_segments(five_points, {0, 3, 5}, {4});
  EXPECT_EQ(fibers.segment_radius(1), 4.0);
  EXPECT_EQ(fibers.radii(), std::vector<double>{4.0}) << "one for all takes no memory";
  fibers.assign_segments(five_points, {0, 3, 5}, {1, 3, 0, 2, 0});
  EXPECT_EQ(fibers.segment_radius(3), 2.0);
}

TEST(FiberAssembly, CountsAConicalSegmentAsItsLargerRadius) {
  const FiberAssembly fibers(five_points, {0, 3, 5}, {1, 3, 2, 5, 4});
  EXPECT_EQ(fibers.segment_radius(0), 3.0);
  EXPECT_EQ(fibers.segment_radius(1), 3.0);
  EXPECT_EQ(fibers.segment_radius(3), 5.0);
}

TEST(FiberAssembly, NamesFiberPointAndValueOfABadCoordinate) {
  std::vector<Vector3d> points = five_points;
  points[4].y() = nan;
  EXPECT_EQ(
      error_of_assembly(points, {0, 3, 5}, {0.1}),
      "fibre 1, point 1: y is nan, coordinates must be finite and at most 1e150 m in magnitude");
  points[4].y() = -infinity;
  EXPECT_NE(error_of_assembly(points, {0, 3, 5}, {0.1}).find("fibre 1, point 1: y is -inf"),
            std::string::npos);
  points[4].y() = 1e151;
  EXPECT_NE(error_of_assembly(points, {0, 3, 5}, {0.1}).find("y is 1e+151"), std::string::npos)
      << error_of_assembly(points, {0, 3, 5}, {0.1});
}

TEST(FiberAssembly, NamesFiberPointAndValueOfABadRadius) {
  EXPECT_EQ(error_of_assembly(five_points, {0, 3, 5}, {-0.5}),
            "the radius is -0.5, radii must be finite, at least 0 and at most 1e150 m");
  EXPECT_NE(
      error_of_assembly(five_points, {0, 3, 5}, {0.1, nan}).find("fibre 1: the radius is nan"),
      std::string::npos);
  EXPECT_NE(error_of_assembly(five_points, {0, 3, 5}, {1, 1, 1, 1, infinity})
                .find("fibre 1, point 1: the radius is inf"),
            std::string::npos);
  EXPECT_EQ(error_of_assembly(five_points, {0, 3, 5}, {1, 1, 1}),
            "3 radii for 2 fibre(s) of 5 points in all; give 1, one per fibre, or one per point");
}

TEST(FiberAssembly, RefusesBadOffsets) {
  EXPECT_EQ(error_of_assembly(five_points, {}, {0.1}), "offsets must start with 0, but are empty");
  EXPECT_EQ(error_of_assembly(five_points, {1, 5}, {0.1}), "offsets must start with 0, not 1");
  EXPECT_EQ(error_of_assembly(five_points, {0, 4, 2, 5}, {0.1}),
            "fibre 1: offsets decrease from 4 to 2");
  EXPECT_EQ(error_of_assembly(five_points, {0, 3, 7}, {0.1}),
            "fibre 1: offset 7 lies beyond the 5 points");
  EXPECT_EQ(error_of_assembly(five_points, {0, 3}, {0.1}),
            "the last offset is 3, but there are 5 points");
  EXPECT_EQ(error_of_assembly(five_points, {0, 4, 5}, {0.1}),
            "fibre 1: has 1 point(s), a fibre needs at least 2");
  EXPECT_EQ(error_of_assembly(five_points, {0, 3, 3, 5}, {0.1}),
            "fibre 1: has 0 point(s), a fibre needs at least 2");
}

TEST(FiberAssembly, UpdateMovesThePointsOrLeavesAllAsItWas) {
  FiberAssembly fibers(five_points, {0, 3, 5}, {0.1});
  std::vector<Vector3d> moved = five_points;
  moved[2].z() = 7.0;
  fibers.update_points(moved);
  EXPECT_EQ(fibers.points()[2].z(), 7.0);

  moved[0].x() = 3.0;
  moved[4].x() = nan;
  EXPECT_NE(error_of([&] { fibers.update_points(moved); }).find("fibre 1, point 1: x is nan"),
            std::string::npos);
  EXPECT_EQ(fibers.points()[0].x(), 0.0);

  moved.pop_back();
  EXPECT_EQ(error_of([&] { fibers.update_points(moved); }),
            "update with 4 points for an assembly of 5");
}

TEST(FiberAssembly, ExchangeTakesThePointsOrLeavesBothAsTheyWere) {
  FiberAssembly fibers(five_points, {0, 3, 5}, {0.1});
  std::vector<Vector3d> moved = five_points;
  moved[2].z() = 7.0;
  const Vector3d* memory = moved.data();
  fibers.exchange_points(moved);
  EXPECT_EQ(fibers.points().data(), memory);
  EXPECT_EQ(fibers.points()[2].z(), 7.0);
  EXPECT_EQ(moved, five_points);

  moved[4].x() = nan;
  EXPECT_NE(error_of([&] { fibers.exchange_points(moved); }).find("fibre 1, point 1: x is nan"),
            std::string::npos);
  EXPECT_TRUE(std::isnan(moved[4].x()));
  EXPECT_EQ(fibers.points().data(), memory);

  moved.pop_back();
  EXPECT_EQ(error_of([&] { fibers.exchange_points(moved); }),
            "update with 4 points for an assembly of 5");
}

TEST(FiberAssembly, TransformMovesThePointsInPlaceOrLeavesThemAsTheyWere) {
  FiberAssembly fibers(five_points, {0, 3, 5}, {0.1});
  const Vector3d* const memory = fibers.points().data();
  const Eigen::Isometry3d pose = Eigen::Translation3d(1.0, 2.0, 3.0) *
                                 Eigen::AngleAxisd(0.7, Vector3d(1.0, -2.0, 0.5).normalized());
  fibers.transform(pose);
  EXPECT_EQ(fibers.points().data(), memory);
  for (std::size_t i = 0; i < five_points.size(); ++i) {
    EXPECT_EQ(fibers.points()[i], pose * five_points[i]);
  }

  std::vector<Vector3d> far = five_points;
  far[4].y() = FiberAssembly::max_coordinate;
  fibers.update_points(far);
  const Eigen::Isometry3d away(Eigen::Translation3d(0.0, FiberAssembly::max_coordinate, 0.0));
  EXPECT_NE(error_of([&] { fibers.transform(away); }).find("fibre 1, point 1: y is 2e+150"),
            std::string::npos);
  EXPECT_EQ(fibers.points(), far);
}

}  // namespace
}  // namespace fiber
