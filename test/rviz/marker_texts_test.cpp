#include "src/rviz/marker_texts.hpp"

#include <gtest/gtest.h>

namespace fiber_proximity_rviz {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

Marker marker(const char* ns, int id, const char* text, int action = Marker::ADD) {
  Marker result;
  result.ns = ns;
  result.id = id;
  result.action = action;
  result.type = Marker::TEXT_VIEW_FACING;
  result.text = text;
  result.color.r = static_cast<float>(id);
  return result;
}

MarkerArray message(const std::vector<Marker>& markers) {
  MarkerArray result;
  result.markers = markers;
  return result;
}

std::vector<std::string> texts(const MarkerTexts& lines) {
  std::vector<std::string> result;
  for (const fiber_proximity_ros::LegendLine& line : lines.lines()) {
    result.push_back(line.text);
  }
  return result;
}

using Texts = std::vector<std::string>;

TEST(MarkerTexts, AreTheLegendBelowWhatIsIncompleteAndNothingElse) {
  MarkerTexts lines;
  EXPECT_TRUE(lines.lines().empty());
  lines.take(message({marker("names", 0, "rope"), marker("legend", 1, "\namber"),
                      marker("legend", 0, "red\n"), marker("incomplete", 0, "no rope")}));
  EXPECT_EQ(texts(lines), (Texts{"no rope", "red", "amber"}));
  EXPECT_EQ(lines.lines()[2].color[0], 1.0F);
}

TEST(MarkerTexts, ComeAndGoWithTheirMarkers) {
  MarkerTexts lines;
  lines.take(message({marker("legend", 0, "red"), marker("legend", 1, "amber")}));
  lines.take(message({marker("legend", 0, "crimson"), marker("legend", 1, "", Marker::DELETE)}));
  EXPECT_EQ(texts(lines), (Texts{"crimson"}));
  lines.take(message({marker("legend", 7, "new"), marker("", 0, "", Marker::DELETEALL)}));
  EXPECT_TRUE(lines.lines().empty());
  lines.take(message({marker("legend", 0, "red")}));
  lines.clear();
  EXPECT_TRUE(lines.lines().empty());
}

}  // namespace
}  // namespace fiber_proximity_rviz
