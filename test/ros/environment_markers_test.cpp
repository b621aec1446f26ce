#include "src/ros/outputs/environment_markers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "fiber_proximity/environment/environment.hpp"
#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/outputs/markers.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;
using fiber::FiberAssembly;
using visualization_msgs::Marker;

fiber::EnvironmentObject ball(const std::string& name, const Vector3d& place) {
  fiber::EnvironmentObject object;
  object.name = name;
  object.pose.translation() = place;
  object.shapes.push_back({fiber::SphereShape{0.05}, Eigen::Isometry3d::Identity()});
  return object;
}

/// Drawer, its inputs and the last output: a fibre along x, and balls.
class EnvironmentMarkersTest : public testing::Test {
 protected:
  EnvironmentMarkersTest()
      : fibers_({{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}}, {0, 3}, {0.01}),
        objects_({ball("near", {0.5, 0.1, 0}), ball("robot/hand", {1.0, 0, 0.2})}) {
    header_.frame_id = "world";
    header_.stamp = ros::Time(12, 34);
    options_.show_fibers = false;
  }

  /// Asks the environment as the node does, and draws.
  void draw(double margin = 1.0) {
    const fiber::Environment environment(objects_);
    fiber::QueryOptions query;
    query.margin = margin;
    query.type = fiber::QueryType::FIBER_PAIRS;
    fiber::QueryResult result;
    environment.query(fibers_, query, {}, result);
    const EnvironmentDrawing around{environment.objects(), result.contacts, result.closest()};
    const std::vector<fiber::Contact> none;
    const std::vector<fiber::NodeBox> boxes;
    const std::string cost;
    Drawing drawing{fibers_, none, nullptr, boxes, cost};
    drawing.environment = &around;
    builder_.build(header_, drawing, options_, array_);
  }

  const Marker* find(const std::string& ns, int id = 0, int action = Marker::ADD) const {
    const auto found =
        std::find_if(array_.markers.begin(), array_.markers.end(), [&](const Marker& marker) {
          return marker.ns == ns && marker.id == id && marker.action == action;
        });
    return found == array_.markers.end() ? nullptr : &*found;
  }

  std::size_t count(const std::string& ns, int action = Marker::ADD) const {
    return static_cast<std::size_t>(std::count_if(
        array_.markers.begin(), array_.markers.end(),
        [&](const Marker& marker) { return marker.ns == ns && marker.action == action; }));
  }

  std::size_t deletions() const {
    return static_cast<std::size_t>(
        std::count_if(array_.markers.begin(), array_.markers.end(),
                      [](const Marker& marker) { return marker.action == Marker::DELETE; }));
  }

  std_msgs::Header header_;
  FiberAssembly fibers_;
  std::vector<fiber::EnvironmentObject> objects_;
  MarkerOptions options_;
  MarkerBuilder builder_;
  visualization_msgs::MarkerArray array_;
};

TEST_F(EnvironmentMarkersTest, ObstaclesAndLinksAreHalfTransparentAndHaveNamespacesOfTheirOwn) {
  draw();
  for (const char* ns : {"obstacles", "robot"}) {
    const Marker* marker = find(ns);
    ASSERT_NE(marker, nullptr) << ns;
    EXPECT_EQ(marker->type, Marker::SPHERE);
    EXPECT_EQ(marker->header.frame_id, "world");
    EXPECT_EQ(marker->header.stamp, ros::Time(12, 34));
    EXPECT_LT(marker->color.a, 1.0F);
    EXPECT_GT(marker->color.a, 0.0F);
    EXPECT_EQ(count(ns), 1U);
  }
  EXPECT_EQ(find("obstacles")->pose.position.y, 0.1);
  EXPECT_EQ(find("robot")->pose.position.z, 0.2);
}

TEST_F(EnvironmentMarkersTest, AShapeIsWhereItsObjectHasIt) {
  objects_[0].pose.linear() = Eigen::AngleAxisd(0.5 * M_PI, Vector3d::UnitZ()).matrix();
  objects_[0].shapes[0].pose.translation() = Vector3d(0.1, 0, 0);
  draw();
  ASSERT_EQ(count("obstacles"), 1U);
  EXPECT_NEAR(find("obstacles")->pose.position.y, 0.2, 1e-12);
}

TEST_F(EnvironmentMarkersTest, OnlyObjectsWithinReachAreDrawn) {
  // From the fibre's surface at y = 0.01 to the ball's box; and beyond an end.
  const double reach = options_.reach;
  for (const Vector3d& outwards : {Vector3d(0, 1, 0), Vector3d(1, 0, 0)}) {
    const Vector3d place = Vector3d(outwards.x(), 0, 0) + (0.01 + reach + 0.05) * outwards;
    objects_ = {ball("at", place - 1e-9 * outwards), ball("beyond", place + 1e-9 * outwards)};
    draw();
    ASSERT_EQ(count("obstacles"), 1U);
    EXPECT_EQ(find("obstacles")->pose.position.x, place.x() - 1e-9 * outwards.x());
  }
  options_.reach = 0.0;
  draw();
  EXPECT_EQ(count("obstacles"), 0U);
}

TEST_F(EnvironmentMarkersTest, InTheMiddleOfTheFibersIsNotNearThem) {
  // Within the box around an L, but far from its legs.
  fibers_ = FiberAssembly({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}}, {0, 3}, {0.01});
  objects_ = {ball("between", {0.8, 1.2, 0})};
  draw();
  EXPECT_EQ(count("obstacles"), 0U);
}

TEST_F(EnvironmentMarkersTest, AFloorFarBelowIsNotDrawn) {
  objects_ = {ball("floor", {0, 0, -options_.reach - 0.02})};
  objects_[0].shapes[0].shape = fiber::HalfSpaceShape{};
  draw();
  EXPECT_EQ(count("obstacles"), 0U);
  objects_[0].pose.translation().z() = -options_.reach;
  draw();
  ASSERT_EQ(count("obstacles"), 1U);
  EXPECT_EQ(find("obstacles")->type, Marker::CUBE);
}

TEST_F(EnvironmentMarkersTest, LinesJoinNearestPointsAndHaveTheColorOfTheirDistance) {
  draw();
  const Marker* lines = find("environment_distances");
  ASSERT_NE(lines, nullptr);
  EXPECT_EQ(lines->type, Marker::LINE_LIST);
  EXPECT_GT(lines->scale.x, 0.0);
  ASSERT_EQ(lines->points.size(), 4U);
  ASSERT_EQ(lines->colors.size(), 4U);
  // From the fibre's surface to the ball's; the ball at the end is further away.
  EXPECT_NEAR(lines->points[0].y, 0.01, 1e-9);
  EXPECT_NEAR(lines->points[1].y, 0.05, 1e-9);
  EXPECT_NEAR(lines->points[3].z, 0.15, 1e-9);
  EXPECT_EQ(lines->colors[0], distance_color(0.04, options_.free_distance));
  EXPECT_EQ(lines->colors[1], lines->colors[0]);
  EXPECT_EQ(lines->colors[2], distance_color(0.14, options_.free_distance));
  const Marker* points = find("environment_points");
  ASSERT_NE(points, nullptr);
  EXPECT_EQ(points->type, Marker::SPHERE_LIST);
  ASSERT_EQ(points->points.size(), 2U);
  EXPECT_EQ(points->points[0], lines->points[1]);
  EXPECT_EQ(points->colors[1], lines->colors[2]);
}

TEST_F(EnvironmentMarkersTest, ColorsGoFromRedOverYellowToGreen) {
  const auto at = [](double distance) { return distance_color(distance, 0.1); };
  EXPECT_EQ(at(-1.0), at(0.0));
  EXPECT_EQ(at(0.1), at(7.0));
  EXPECT_GT(at(0.0).r, 0.9F);
  EXPECT_LT(at(0.0).g, 0.3F);
  EXPECT_GT(at(0.05).r, 0.9F);
  EXPECT_GT(at(0.05).g, 0.8F);
  EXPECT_LT(at(0.1).r, 0.3F);
  EXPECT_GT(at(0.1).g, 0.7F);
  for (int i = 0; i < 10; ++i) {
    const auto near = at(0.01 * i);
    const auto far = at(0.01 * (i + 1));
    EXPECT_LT(near.g - near.r, far.g - far.r) << i;
    EXPECT_EQ(near.a, 1.0F);
  }
}

TEST_F(EnvironmentMarkersTest, TheClosestPairHasItsObjectsNameAndDistanceInMillimetres) {
  objects_[1].pose.translation().z() = 0.0723;  // 12.3 mm
  draw();
  const Marker* line = find("environment_nearest");
  ASSERT_NE(line, nullptr);
  EXPECT_EQ(line->type, Marker::LINE_LIST);
  ASSERT_EQ(line->points.size(), 2U);
  EXPECT_NEAR(line->points[0].z, 0.01, 1e-9);
  EXPECT_NEAR(line->points[1].z, 0.0223, 1e-9);
  const Marker* text = find("environment_nearest_text");
  ASSERT_NE(text, nullptr);
  EXPECT_EQ(text->type, Marker::TEXT_VIEW_FACING);
  EXPECT_EQ(text->text, "robot/hand: 12.3 mm");
  EXPECT_GT(text->scale.z, 0.0);
  EXPECT_EQ(text->pose.position.x, line->points[1].x);
  // Below the hand, which is above the fibre: its inside would hide the text.
  EXPECT_LT(text->pose.position.z, line->points[1].z);
  const Marker* leader = find("environment_nearest_leader");
  ASSERT_NE(leader, nullptr);
  ASSERT_EQ(leader->points.size(), 2U);
  EXPECT_EQ(leader->points[0], line->points[1]) << "it begins at the object";
  const Vector3d place = to_vector(text->pose.position);
  EXPECT_LT((to_vector(leader->points[1]) - place).norm(),
            (to_vector(leader->points[0]) - place).norm());
}

/// Where the text is, whatever the highest point of the fibres.
TEST_F(EnvironmentMarkersTest, TheTextLiesAtTheObjectThatItNames) {
  // A fibre from a table up to a rail, as the object of another name.
  fibers_ = FiberAssembly({{0, 0, 0.02}, {0.5, 0, 0.02}, {1, 0, 0.9}}, {0, 3}, {0.01});
  objects_ = {ball("table", {0.25, 0, -0.05}), ball("rail", {1.0, 0, 1.0})};
  draw();
  const Marker* text = find("environment_nearest_text");
  ASSERT_NE(text, nullptr);
  EXPECT_EQ(text->text.rfind("table", 0), 0U) << text->text;
  const Vector3d place = to_vector(text->pose.position);
  const double to_table = (place - Vector3d(0.25, 0, 0)).norm();
  EXPECT_LT(to_table, 0.2) << "of fibres of 1 m";
  EXPECT_LT(to_table, 0.25 * (place - Vector3d(1.0, 0, 1.0)).norm());
}

TEST_F(EnvironmentMarkersTest, DeletesWhatVanishedOnceAndNothingElse) {
  draw();
  EXPECT_EQ(array_.markers.size(), 7U);
  EXPECT_EQ(deletions(), 0U);
  objects_.pop_back();
  draw(0.01);
  EXPECT_NE(find("obstacles"), nullptr);
  for (const char* ns :
       {"robot", "environment_distances", "environment_points", "environment_nearest",
        "environment_nearest_leader", "environment_nearest_text"}) {
    EXPECT_NE(find(ns, 0, Marker::DELETE), nullptr) << ns;
  }
  EXPECT_EQ(deletions(), 6U);
  draw(0.01);
  EXPECT_EQ(deletions(), 0U);
}

TEST_F(EnvironmentMarkersTest, ComeAfterTheFibers) {
  options_.show_fibers = true;
  draw();
  ASSERT_EQ(array_.markers.size(), 8U);
  EXPECT_EQ(array_.markers[0].ns, "fibers");
  EXPECT_EQ(array_.markers[1].ns, "obstacles");
}

TEST_F(EnvironmentMarkersTest, OptionsTurnPartsOff) {
  draw();
  options_.show_objects = options_.show_contacts = options_.show_nearest = false;
  draw();
  EXPECT_EQ(array_.markers.size(), 7U);
  EXPECT_EQ(deletions(), 7U);
}

TEST_F(EnvironmentMarkersTest, NoFibersNoMarkers) {
  fibers_ = FiberAssembly();
  draw();
  EXPECT_TRUE(array_.markers.empty());
}

}  // namespace
}  // namespace fiber_proximity_ros
