#include <gtest/gtest.h>

#include "fiber_proximity/query/crossings.hpp"
#include "src/ros/outputs/markers.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber::FiberAssembly;
using visualization_msgs::Marker;

// b over a, seen from above: in front of their surfaces, whole above and parted below.
TEST(CrossingMarkers, AreABarOverAndStubsUnder) {
  const FiberAssembly fibers({{-1, 0, 0}, {1, 0, 0}, {0, -1, 0.5}, {0, 1, 0.5}}, {0, 2, 4}, {0.1});
  const fiber::View view;
  std::vector<fiber::Crossing> crossings = fiber::find_crossings(fibers, view);
  ASSERT_EQ(crossings.size(), 1U);
  Marker marker;
  draw_crossings(fibers, {crossings, view}, 0.2, marker);
  EXPECT_EQ(marker.scale.x, 0.2);
  ASSERT_EQ(marker.points.size(), 6U);
  ASSERT_EQ(marker.colors.size(), 6U);
  EXPECT_EQ(marker.points[0].x, 0.0);
  EXPECT_EQ(marker.points[0].y, -0.5);
  EXPECT_DOUBLE_EQ(marker.points[0].z, 0.61);
  EXPECT_EQ(marker.points[1].y, 0.5);
  EXPECT_EQ(marker.points[2].x, -0.5);
  EXPECT_EQ(marker.points[3].x, -0.2);
  EXPECT_EQ(marker.points[4].x, 0.2);
  EXPECT_EQ(marker.points[5].x, 0.5);
  EXPECT_DOUBLE_EQ(marker.points[5].z, 0.11);
  EXPECT_GT(marker.colors[0].r, marker.colors[0].g) << "the sign is -1";
  crossings[0].sign = 1;
  draw_crossings(fibers, {crossings, view}, 0.2, marker);
  ASSERT_EQ(marker.points.size(), 12U);
  EXPECT_GT(marker.colors[6].g, marker.colors[6].r);
}

}  // namespace
}  // namespace fiber_proximity_ros
