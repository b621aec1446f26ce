// The texts beside the fibres: names, the legend with its axes, the cost.
#include <cmath>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/outputs/markers.hpp"
#include "test/ros/markers_fixture.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber::FiberAssembly;
using visualization_msgs::Marker;

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
  names_.assign(MarkerBuilder::max_names, "one of many");
  build(parallel_fibers(MarkerBuilder::max_names));
  EXPECT_NE(find("names", MarkerBuilder::max_names - 1), nullptr);
  names_.emplace_back("one too many");
  build(parallel_fibers(MarkerBuilder::max_names + 1));
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

// Whoever looks from the front, from above, sees what is behind higher up.
TEST_F(Markers, LegendIsBelowTheFibersAndInFrontOfThem) {
  legend_ = legend_lines(options_, {}, 0.02);
  options_.show_legend = true;
  const FiberAssembly fibers = parallel_fibers(8);  // 0.2 m by 0.21 m, flat on a table
  build(fibers);
  for (const double pitch : {0.0, 0.3, 0.68, 1.2}) {
    const Eigen::Vector3d up(0.0, std::sin(pitch), std::cos(pitch));  // of the picture
    const Marker* line = find("legend");
    ASSERT_NE(line, nullptr);
    const double block = static_cast<double>(legend_.size()) * line->scale.z;
    const double upper_edge = up.dot(to_vector(line->pose.position)) + 0.5 * block;
    for (const Eigen::Vector3d& point : fibers.points()) {
      EXPECT_LT(upper_edge, up.dot(point)) << pitch;
    }
  }
}

TEST_F(Markers, NamesAreNearTheirEnds) {
  names_ = {"pc"};
  options_.show_names = true;
  build(parallel_fibers(1, 41));  // 4 m, as wide as the picture
  const Marker* name = find("names");
  ASSERT_NE(name, nullptr);
  // The end is at the origin, the fibre 2 cm thick; the text has two letters.
  EXPECT_LT(to_vector(name->pose.position).norm(), 0.02 + 2.0 * name->scale.z);
}

TEST_F(Markers, WhatAnAnswerLacksIsRedAboveAllAndThereWithoutFibersToo) {
  build(parallel_fibers(2));
  EXPECT_EQ(find("incomplete"), nullptr);
  unknown_ = {"robot/arm since 12.5: no transform"};
  build(parallel_fibers(2));
  const Marker* text = find("incomplete");
  ASSERT_NE(text, nullptr);
  EXPECT_EQ(text->type, Marker::TEXT_VIEW_FACING);
  EXPECT_EQ(text->text, "incomplete: robot/arm since 12.5: no transform");
  EXPECT_GT(text->color.r, 2.0F * text->color.g);
  EXPECT_GT(text->pose.position.z, 0.0);
  unknown_.emplace_back("rope since 3: stale");
  build(FiberAssembly());
  text = find("incomplete");
  ASSERT_NE(text, nullptr) << "a tracker that is gone leaves no fibres";
  EXPECT_EQ(text->text, "incomplete: robot/arm since 12.5: no transform; and 1 more");
  EXPECT_GT(text->scale.z, 0.0);
  unknown_.clear();
  build(parallel_fibers(2));
  EXPECT_NE(find("incomplete", 0, Marker::DELETE), nullptr);
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
  const std::string penetrating = "red: penetrating";
  const std::string normals = "lines: normals of contacts";
  const std::string nearest = "white: nearest pair";
  using Texts = std::vector<std::string>;
  EXPECT_EQ(texts_of(legend_lines(options, false, 0.0)), (Texts{penetrating, normals, nearest}));
  EXPECT_EQ(texts_of(legend_lines(options, false, 0.02)),
            (Texts{penetrating, "amber: within 20.0 mm", normals, nearest}));
  EXPECT_EQ(texts_of(legend_lines(options, false, HUGE_VAL)),
            (Texts{penetrating, "amber: apart", normals, nearest}));
  options.certain_margin = 0.0;
  EXPECT_EQ(texts_of(legend_lines(options, false, 0.0)),
            (Texts{penetrating, "pale: possible, not certain", normals, nearest}));
  options = {};
  options.show_nearest = false;
  EXPECT_EQ(texts_of(legend_lines(options, true, 0.0)),
            (Texts{penetrating, normals, "red to green: from objects, 0 to 100.0 mm"}));
  options.show_contacts = false;
  options.show_boxes = true;
  options.show_crossings = true;
  EXPECT_EQ(
      texts_of(legend_lines(options, false, 0.0)),
      (Texts{"green: crossing of sign +1", "magenta: crossing of sign -1", "boxes: level 4"}));
}

TEST_F(Markers, CostIsATextAboveTheFibersIfAskedFor) {
  cost_ = "of the answer";
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

}  // namespace
}  // namespace fiber_proximity_ros
