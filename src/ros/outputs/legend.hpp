#pragma once

#include <string>
#include <vector>

#include "src/ros/outputs/environment_markers.hpp"
#include "src/ros/outputs/markers.hpp"
#include "src/ros/outputs/palette.hpp"

namespace fiber_proximity_ros {

/// What the colours of the markers mean that these options show: a line for each.
/// @param margin [m] of the contacts; may be infinite
std::vector<LegendLine> legend_lines(const MarkerOptions& options,
                                     const EnvironmentMarkerOptions& environment, double margin);

}  // namespace fiber_proximity_ros
