#pragma once

#include <string>
#include <vector>

#include "fiber_proximity/ros/environment_markers.hpp"
#include "fiber_proximity/ros/markers.hpp"
#include "fiber_proximity/ros/palette.hpp"

namespace fiber_proximity_ros {

/// What the colours of the markers mean that these options show: a line for each.
/// @param margin [m] of the contacts; may be infinite
std::vector<LegendLine> legend_lines(const MarkerOptions& options,
                                     const EnvironmentMarkerOptions& environment, double margin);

}  // namespace fiber_proximity_ros
