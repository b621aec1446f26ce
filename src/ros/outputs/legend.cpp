#include "src/ros/outputs/legend.hpp"

#include <cmath>

namespace fiber_proximity_ros {

std::vector<LegendLine> legend_lines(const MarkerOptions& options,
                                     const EnvironmentMarkerOptions& environment, double margin) {
  std::vector<LegendLine> lines;
  if (options.show_contacts) {
    lines.push_back({palette::penetrating, "red: penetrating"});
    if (margin > 0.0) {
      lines.push_back({palette::within_margin, std::isfinite(margin)
                                                   ? "amber: within " + distance_text(margin)
                                                   : "amber: apart"});
    }
  }
  if (options.show_passed) {
    lines.push_back({palette::passed, "cyan: came and went between two messages"});
  }
  if (environment.show_distances) {
    lines.push_back({palette::distant, "red to green: from objects, 0 to " +
                                           distance_text(environment.free_distance)});
  }
  if (options.show_crossings) {
    lines.push_back({palette::positive_crossing, "green: crossing of sign +1"});
    lines.push_back({palette::negative_crossing, "magenta: crossing of sign -1"});
  }
  if (options.show_boxes) {
    lines.push_back({palette::boxes, "boxes: level " + std::to_string(options.level)});
  }
  if (options.show_nearest) {
    lines.push_back({palette::nearest, "white: nearest pair"});
  }
  return lines;
}

}  // namespace fiber_proximity_ros
