#include "src/rviz/marker_texts.hpp"

#include <array>

namespace fiber_proximity_rviz {
namespace {

using fiber_proximity_ros::LegendLine;
using visualization_msgs::Marker;

constexpr std::array<const char*, 2> namespaces{"incomplete", "legend"};

/// Without the empty lines that move it below those above, where all are at one place.
std::string line_of(const std::string& text) {
  const std::size_t begin = text.find_first_not_of('\n');
  return begin == std::string::npos ? ""
                                    : text.substr(begin, text.find_last_not_of('\n') + 1 - begin);
}

}  // namespace

void MarkerTexts::take(const visualization_msgs::MarkerArray& message) {
  for (const Marker& marker : message.markers) {
    if (marker.action == Marker::DELETEALL) {
      texts_.clear();
    } else if (marker.action == Marker::DELETE) {
      texts_[marker.ns].erase(marker.id);
    } else if (marker.type == Marker::TEXT_VIEW_FACING) {
      texts_[marker.ns][marker.id] = {{marker.color.r, marker.color.g, marker.color.b},
                                      line_of(marker.text)};
    }
  }
}

std::vector<LegendLine> MarkerTexts::lines() const {
  std::vector<LegendLine> lines;
  for (const char* name : namespaces) {
    const auto found = texts_.find(name);
    if (found == texts_.end()) {
      continue;
    }
    for (const auto& [id, line] : found->second) {
      lines.push_back(line);
    }
  }
  return lines;
}

}  // namespace fiber_proximity_rviz
