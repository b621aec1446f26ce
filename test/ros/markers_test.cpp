#include "src/ros/outputs/markers.hpp"

#include <cmath>

#include "test/ros/markers_fixture.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber::FiberAssembly;
using visualization_msgs::Marker;

TEST_F(Markers, DrawsOneTubePerFiberInItsOwnColor) {
  build(parallel_fibers(3));
  ASSERT_EQ(array_.markers.size(), 3U);
  for (int fiber = 0; fiber < 3; ++fiber) {
    const Marker* tube = find("fibers", fiber);
    ASSERT_NE(tube, nullptr);
    EXPECT_EQ(tube->type, Marker::TRIANGLE_LIST);
    EXPECT_EQ(tube->header.frame_id, "world");
    EXPECT_EQ(tube->header.stamp, ros::Time(12, 34));
    EXPECT_EQ(tube->pose.orientation.w, 1.0);
    EXPECT_EQ(tube->scale.x, 1.0);
    EXPECT_FALSE(tube->points.empty());
    EXPECT_EQ(tube->points.size() % 3, 0U);
  }
  EXPECT_NE(find("fibers", 0)->color.r, find("fibers", 1)->color.r);
}

TEST_F(Markers, ManySegmentsBecomeLines) {
  const auto points = static_cast<std::uint32_t>(MarkerBuilder::max_tube_segments / 2 + 1);
  build(parallel_fibers(2, points));
  EXPECT_EQ(find("fibers", 0)->type, Marker::TRIANGLE_LIST);
  build(parallel_fibers(2, points + 1));
  const Marker* lines = find("fibers", 0);
  ASSERT_NE(lines, nullptr);
  EXPECT_EQ(lines->type, Marker::LINE_LIST);
  EXPECT_EQ(lines->points.size(), 4U * points);
  EXPECT_EQ(lines->colors.size(), lines->points.size());
  EXPECT_DOUBLE_EQ(lines->scale.x, 0.02);
  EXPECT_NE(find("fibers", 1, Marker::DELETE), nullptr);
  EXPECT_EQ(deletions(), 1U);
}

TEST_F(Markers, ContactsAreRedInPenetrationAndAmberWithinTheMargin) {
  add_contact(-0.002);
  add_contact(0.004);
  build(parallel_fibers(2));
  const Marker* spheres = find("contacts");
  ASSERT_NE(spheres, nullptr);
  EXPECT_EQ(spheres->type, Marker::SPHERE_LIST);
  ASSERT_EQ(spheres->points.size(), 2U);
  EXPECT_DOUBLE_EQ(spheres->points[0].y, 0.009);
  EXPECT_DOUBLE_EQ(spheres->points[1].y, 0.012);
  ASSERT_EQ(spheres->colors.size(), 2U);
  EXPECT_LT(spheres->colors[0].g, 0.3F);
  EXPECT_GT(spheres->colors[1].g, 0.5F);

  const Marker* normals = find("normals");
  ASSERT_NE(normals, nullptr);
  EXPECT_EQ(normals->type, Marker::LINE_LIST);
  ASSERT_EQ(normals->points.size(), 4U);
  EXPECT_GT(normals->points[1].y, normals->points[0].y);
  EXPECT_DOUBLE_EQ(normals->points[1].x, normals->points[0].x);
}

TEST_F(Markers, ContactsThatAreOnlyPossibleArePaler) {
  add_contact(-0.002);
  add_contact(-0.002);
  contacts_.contacts[0].upper = 0.001;
  contacts_.contacts[1].upper = 0.003;
  options_.certain_margin = 0.002;
  build(parallel_fibers(2));
  const Marker* spheres = find("contacts");
  ASSERT_NE(spheres, nullptr);
  ASSERT_EQ(spheres->colors.size(), 2U);
  EXPECT_LT(spheres->colors[0].g, 0.3F);
  EXPECT_GT(spheres->colors[1].g, 0.5F);
}

TEST_F(Markers, DiscsDoNotCoverFibersThatAreApart) {
  // Thin fibres of 2 mm beside a thick one of 20 mm.
  const FiberAssembly fibers({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}, {1, 2, 0}},
                             {0, 2, 4, 6}, {0.002, 0.002, 0.02});
  const auto add = [this](std::uint32_t a, std::uint32_t b, double distance) {
    add_contact(distance);
    contacts_.contacts.back().fiber_a = a;
    contacts_.contacts.back().fiber_b = b;
  };
  add(2, 2, -0.001);
  add(0, 1, 0.0);
  add(0, 2, 0.001);
  add(0, 1, 0.018);
  add(2, 2, 0.021);
  build(fibers);
  std::vector<double> sizes;
  std::size_t points = 0;
  for (const Marker& marker : array_.markers) {
    if (marker.ns == "contacts") {
      EXPECT_EQ(marker.id, static_cast<int>(sizes.size()));
      EXPECT_EQ(marker.points.size(), marker.colors.size());
      EXPECT_EQ(marker.scale.x, marker.scale.y);
      EXPECT_EQ(marker.scale.x, marker.scale.z);
      sizes.push_back(marker.scale.x);
      points += marker.points.size();
    }
  }
  EXPECT_EQ(points, 5U);
  // Those that touch; the thick one and itself, and the thin ones, that are apart.
  const std::vector<double> largest{0.06, 0.03, 0.003};
  ASSERT_EQ(sizes.size(), largest.size());
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    EXPECT_LE(sizes[i], largest[i] * (1.0 + 1e-9));
    EXPECT_GT(sizes[i], 0.8 * largest[i]);
  }
  contacts_.contacts.resize(1);
  build(fibers);
  EXPECT_EQ(deletions(), 2U);
}

TEST_F(Markers, NearestPairHasALineAndItsDistanceInMillimetres) {
  add_contact(0.0123);
  minimum_ = contacts_.contacts.data();
  build(parallel_fibers(2));
  const Marker* line = find("nearest");
  ASSERT_NE(line, nullptr);
  ASSERT_EQ(line->points.size(), 2U);
  EXPECT_DOUBLE_EQ(line->points[0].y, 0.01);
  EXPECT_DOUBLE_EQ(line->points[1].y, 0.0223);
  const Marker* text = find("nearest_text");
  ASSERT_NE(text, nullptr);
  EXPECT_EQ(text->type, Marker::TEXT_VIEW_FACING);
  EXPECT_EQ(text->text, "12.3 mm");
  EXPECT_GT(text->scale.z, 0.0);
}

TEST_F(Markers, BoxesAreTheirTwelveEdges) {
  boxes_.push_back({{0, 0, 0}, {1, 2, 3}});
  boxes_.push_back({{1, 1, 1}, {2, 2, 2}});
  build(parallel_fibers(1));
  const Marker* boxes = find("boxes");
  ASSERT_NE(boxes, nullptr);
  EXPECT_EQ(boxes->type, Marker::LINE_LIST);
  EXPECT_LT(boxes->color.a, 1.0F);
  ASSERT_EQ(boxes->points.size(), 2U * 24U);
  double length = 0.0;
  for (std::size_t i = 0; i < 24; i += 2) {
    const geometry_msgs::Point& a = boxes->points[i];
    const geometry_msgs::Point& b = boxes->points[i + 1];
    length += std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.z - b.z);
  }
  EXPECT_DOUBLE_EQ(length, 4.0 * (1 + 2 + 3));
}

TEST_F(Markers, DeletesWhatVanishedOnceAndNothingElse) {
  add_contact(0.0);
  minimum_ = contacts_.contacts.data();
  boxes_.push_back({{0, 0, 0}, {1, 1, 1}});
  build(parallel_fibers(3));
  EXPECT_EQ(array_.markers.size(), 3U + 6U);
  EXPECT_EQ(deletions(), 0U);

  contacts_.contacts.clear();
  minimum_ = nullptr;
  build(parallel_fibers(1));
  EXPECT_EQ(deletions(), 2U + 5U);
  EXPECT_NE(find("fibers", 0), nullptr);
  for (const char* ns : {"contacts", "normals", "nearest", "nearest_leader", "nearest_text"}) {
    EXPECT_NE(find(ns, 0, Marker::DELETE), nullptr) << ns;
  }
  EXPECT_NE(find("fibers", 1, Marker::DELETE), nullptr);
  EXPECT_NE(find("fibers", 2, Marker::DELETE), nullptr);
  EXPECT_EQ(array_.markers.back().action, Marker::DELETE);

  build(parallel_fibers(1));
  EXPECT_EQ(deletions(), 0U);
  build(parallel_fibers(2));
  EXPECT_EQ(deletions(), 0U);
}

TEST_F(Markers, OptionsTurnPartsOff) {
  add_contact(0.0);
  minimum_ = contacts_.contacts.data();
  boxes_.push_back({{0, 0, 0}, {1, 1, 1}});
  build(parallel_fibers(2));
  options_ = {false, false, false, false};
  build(parallel_fibers(2));
  EXPECT_EQ(array_.markers.size(), 2U + 6U);
  EXPECT_EQ(deletions(), array_.markers.size());
}

TEST_F(Markers, NoFibersNoMarkers) {
  build(FiberAssembly());
  EXPECT_TRUE(array_.markers.empty());
}

}  // namespace
}  // namespace fiber_proximity_ros
