#pragma once

#include <string>
#include <vector>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/outputs/marker_canvas.hpp"
#include "src/ros/outputs/marker_scale.hpp"

namespace fiber_proximity_ros {

/// What a colour means.
struct LegendLine {
  Rgb color;
  std::string text;
};

/// Draws lines below what is drawn. Each is a marker of its own, for its colour; all are at one
/// place, where empty lines above and below move each to its own, from wherever one looks.
/// @param ns the canvas's namespace
template <class Canvas>
void draw_legend(const std::vector<LegendLine>& legend, const MarkerScale& scale, std::size_t ns,
                 Canvas& canvas) {
  for (std::size_t line = 0; line < legend.size(); ++line) {
    visualization_msgs::Marker& text = canvas.add(ns, visualization_msgs::Marker::TEXT_VIEW_FACING);
    text.scale.z = 0.03 * scale.extent;
    text.pose.position = to_message(scale.bottom() - 0.15 * scale.extent * scale.up);
    text.color = color(legend[line].color);
    text.text =
        std::string(line, '\n') + legend[line].text + std::string(legend.size() - 1 - line, '\n');
  }
}

}  // namespace fiber_proximity_ros
