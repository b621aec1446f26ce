#include "src/ros/outputs/markers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "fiber_proximity/query/crossings.hpp"
#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/outputs/legend.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber::FiberAssembly;
using visualization_msgs::Marker;

FiberAssembly parallel_fibers(std::uint32_t count, std::uint32_t points = 3) {
  std::vector<Eigen::Vector3d> all;
  std::vector<std::uint32_t> offsets{0};
  for (std::uint32_t fiber = 0; fiber < count; ++fiber) {
    for (std::uint32_t i = 0; i < points; ++i) {
      all.emplace_back(0.1 * i, 0.03 * fiber, 0.0);
    }
    offsets.push_back(static_cast<std::uint32_t>(all.size()));
  }
  return {all, offsets, {0.01}};
}

/// Builder, its inputs and the last output.
class Markers : public testing::Test {
 protected:
  Markers() {
    header_.frame_id = "world";
    header_.stamp = ros::Time(12, 34);
    options_.show_boxes = true;
  }

  void build(const FiberAssembly& fibers) {
    builder_.build(
        header_, {fibers, contacts_.contacts, minimum_, boxes_, cost_, nullptr, &names_, &legend_},
        options_, array_);
  }

  void add_contact(double distance) {
    fiber::Contact contact;
    contact.fiber_b = 1;
    contact.distance = distance;
    contact.point_a = {0.1, 0.01, 0.0};
    contact.point_b = {0.1, 0.01 + distance, 0.0};
    contact.normal = Eigen::Vector3d::UnitY();
    contacts_.contacts.push_back(contact);
  }

  const Marker* find(const std::string& ns, int id = 0, int action = Marker::ADD) const {
    const auto found =
        std::find_if(array_.markers.begin(), array_.markers.end(), [&](const Marker& marker) {
          return marker.ns == ns && marker.id == id && marker.action == action;
        });
    return found == array_.markers.end() ? nullptr : &*found;
  }

  std::size_t deletions() const {
    return static_cast<std::size_t>(
        std::count_if(array_.markers.begin(), array_.markers.end(),
                      [](const Marker& marker) { return marker.action == Marker::DELETE; }));
  }

  std_msgs::Header header_;
  fiber::QueryResult contacts_;
  const fiber::Contact* minimum_ = nullptr;
  std::vector<fiber::NodeBox> boxes_;
  std::string cost_;
  std::vector<std::string> names_;
  std::vector<LegendLine> legend_;
  MarkerOptions options_;
  MarkerBuilder builder_;
  visualization_msgs::MarkerArray array_;
};

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
  const auto points = static_cast<std::uint32_t>(MarkerBuilder::most_tube_segments / 2 + 1);
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

TEST_F(Markers, NamesAreAboveAndBesideTheFirstPoints) {
  names_ = {"left", "right"};
  build(parallel_fibers(2));
  EXPECT_EQ(find("names"), nullptr) << "nobody asked";
  options_.show_names = true;
  build(parallel_fibers(2));
  for (int fiber = 0; fiber < 2; ++fiber) {
    const Marker* name = find("names", fiber);
    ASSERT_NE(name, nullptr);
    EXPECT_EQ(name->type, Marker::TEXT_VIEW_FACING);
    EXPECT_EQ(name->text, names_[static_cast<std::size_t>(fiber)]);
    EXPECT_LT(name->pose.position.x, 0.0) << "before the fibre";
    EXPECT_DOUBLE_EQ(name->pose.position.y, 0.03 * fiber);
    EXPECT_GT(name->pose.position.z, 0.0);
    EXPECT_GT(name->scale.z, 0.0);
    EXPECT_EQ(name->color.a, 1.0F);
  }
  names_.resize(1);
  build(parallel_fibers(1));
  EXPECT_NE(find("names", 1, Marker::DELETE), nullptr);
  names_.assign(MarkerBuilder::most_names, "one of many");
  build(parallel_fibers(MarkerBuilder::most_names));
  EXPECT_NE(find("names", MarkerBuilder::most_names - 1), nullptr);
  names_.emplace_back("one too many");
  build(parallel_fibers(MarkerBuilder::most_names + 1));
  EXPECT_EQ(find("names"), nullptr);
  EXPECT_NE(find("names", 0, Marker::DELETE), nullptr);
}

TEST_F(Markers, LegendIsOneLineBelowAnother) {
  legend_ = legend_lines(options_, {}, 0.02);
  ASSERT_GE(legend_.size(), 3U);
  build(parallel_fibers(2));
  EXPECT_EQ(find("legend"), nullptr) << "nobody asked";
  options_.show_legend = true;
  build(parallel_fibers(2));
  const auto count = static_cast<int>(legend_.size());
  for (int i = 0; i < count; ++i) {
    const Marker* line = find("legend", i);
    ASSERT_NE(line, nullptr);
    EXPECT_EQ(line->type, Marker::TEXT_VIEW_FACING);
    const std::string& text = legend_[static_cast<std::size_t>(i)].text;
    EXPECT_EQ(line->text.find(text), static_cast<std::size_t>(i)) << "so many empty lines above";
    EXPECT_EQ(line->text.size(), text.size() + legend_.size() - 1);
    EXPECT_EQ(line->color.r, legend_[static_cast<std::size_t>(i)].color[0]);
    EXPECT_LT(line->pose.position.z, 0.0) << "below the fibres";
  }
  EXPECT_EQ(find("legend", count), nullptr);
  legend_.pop_back();
  build(parallel_fibers(2));
  EXPECT_NE(find("legend", count - 1, Marker::DELETE), nullptr);
  build(FiberAssembly());
  EXPECT_NE(find("legend", 0, Marker::DELETE), nullptr);
}

TEST_F(Markers, AxesAreBesideTheFibersWithTheLegend) {
  legend_ = legend_lines(options_, {}, 0.0);
  options_.show_legend = true;
  build(parallel_fibers(2));
  const Marker* axes = find("axes");
  ASSERT_NE(axes, nullptr);
  EXPECT_EQ(axes->type, Marker::LINE_LIST);
  ASSERT_EQ(axes->points.size(), 6U);
  ASSERT_EQ(axes->colors.size(), 6U);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d from = to_vector(axes->points[2 * axis]);
    const Eigen::Vector3d along = to_vector(axes->points[2 * axis + 1]) - from;
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(static_cast<int>(axis));
    EXPECT_GT(along.norm(), 0.01);
    EXPECT_NEAR(along.dot(unit), along.norm(), 1e-12);
    EXPECT_LT(from.z(), -0.01) << "below the fibres";
    const std_msgs::ColorRGBA& color = axes->colors[2 * axis];
    EXPECT_EQ(color.r > 0.5F, axis == 0);
    EXPECT_EQ(color.g > 0.5F, axis == 1);
    EXPECT_EQ(color.b > 0.5F, axis == 2);
  }
  options_.show_legend = false;
  build(parallel_fibers(2));
  EXPECT_NE(find("axes", 0, Marker::DELETE), nullptr);
}

// There y is downwards (REP 103): what is deeper in z would be behind the fibres.
TEST_F(Markers, TextsAreAboveTheFibersInAnOpticalFrame) {
  header_.frame_id = "camera_color_optical_frame";
  add_contact(0.0123);
  minimum_ = contacts_.contacts.data();
  names_ = {"left", "right"};
  legend_ = legend_lines(options_, {}, 0.02);
  cost_ = "any";
  options_.show_names = options_.show_legend = options_.show_cost = true;
  build(parallel_fibers(2));
  for (const char* ns : {"nearest_text", "names", "cost"}) {
    const Marker* text = find(ns);
    ASSERT_NE(text, nullptr) << ns;
    EXPECT_LT(text->pose.position.y, 0.01) << ns << ": the nearest pair is at 0.016";
    EXPECT_DOUBLE_EQ(text->pose.position.z, 0.0) << ns;
  }
  EXPECT_GT(find("legend")->pose.position.y, 0.03);
}

std::vector<std::string> texts_of(const std::vector<LegendLine>& lines) {
  std::vector<std::string> texts;
  for (const LegendLine& line : lines) {
    texts.push_back(line.text);
  }
  return texts;
}

TEST(Legend, TellsOfWhatIsShown) {
  MarkerOptions options;
  EnvironmentMarkerOptions environment;
  environment.show_distances = false;
  const std::string penetrating = "red: penetrating";
  const std::string nearest = "white: nearest pair";
  using Texts = std::vector<std::string>;
  EXPECT_EQ(texts_of(legend_lines(options, environment, 0.0)), (Texts{penetrating, nearest}));
  EXPECT_EQ(texts_of(legend_lines(options, environment, 0.02)),
            (Texts{penetrating, "amber: within 20.0 mm", nearest}));
  EXPECT_EQ(texts_of(legend_lines(options, environment, HUGE_VAL)),
            (Texts{penetrating, "amber: apart", nearest}));
  environment.show_distances = true;
  options.show_nearest = false;
  EXPECT_EQ(texts_of(legend_lines(options, environment, 0.0)),
            (Texts{penetrating, "red to green: from objects, 0 to 100.0 mm"}));
  environment.show_distances = false;
  options.show_contacts = false;
  options.show_boxes = true;
  options.show_crossings = true;
  EXPECT_EQ(
      texts_of(legend_lines(options, environment, 0.0)),
      (Texts{"green: crossing of sign +1", "magenta: crossing of sign -1", "boxes: level 4"}));
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

TEST_F(Markers, CostIsATextAboveTheFibersIfAskedFor) {
  cost_ = cost_text("robust", 0.00123, 4e-16, false);
  EXPECT_EQ(cost_, "robust: 1.23 ms, error <= 4.0e-16 m, cut off");
  EXPECT_EQ(cost_text("fast", 1.0, 1e-7, true), "fast: 1000.00 ms, error <= 1.0e-07 m");
  build(parallel_fibers(2));
  EXPECT_EQ(find("cost"), nullptr);
  options_.show_cost = true;
  build(parallel_fibers(2));
  const Marker* text = find("cost");
  ASSERT_NE(text, nullptr);
  EXPECT_EQ(text->type, Marker::TEXT_VIEW_FACING);
  EXPECT_EQ(text->text, cost_);
  EXPECT_GT(text->pose.position.z, 0.0);
  options_.show_cost = false;
  build(parallel_fibers(2));
  EXPECT_NE(find("cost", 0, Marker::DELETE), nullptr);
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
  EXPECT_EQ(array_.markers.size(), 3U + 5U);
  EXPECT_EQ(deletions(), 0U);

  contacts_.contacts.clear();
  minimum_ = nullptr;
  build(parallel_fibers(1));
  EXPECT_EQ(deletions(), 2U + 4U);
  EXPECT_NE(find("fibers", 0), nullptr);
  for (const char* ns : {"contacts", "normals", "nearest", "nearest_text"}) {
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
  EXPECT_EQ(array_.markers.size(), 2U + 5U);
  EXPECT_EQ(deletions(), array_.markers.size());
}

TEST_F(Markers, NoFibersNoMarkers) {
  build(FiberAssembly());
  EXPECT_TRUE(array_.markers.empty());
}

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
