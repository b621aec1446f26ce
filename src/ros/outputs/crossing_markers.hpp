#pragma once

#include <visualization_msgs/Marker.h>

#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/crossings.hpp"

namespace fiber_proximity_ros {

/// Crossings to draw, and how they are looked at. Holds references: only for the call.
struct CrossingDrawing {
  const std::vector<fiber::Crossing>& crossings;
  const fiber::View& view;
};

/// Draws each crossing as diagrams of knots do, into a LINE_LIST marker: a bar along the strand
/// above, and of the strand below two stubs with a gap between them. In front of the fibres as the
/// view has it; green for the sign +1, magenta for −1.
/// @param thickness [m] of the lines
/// @param marker    gets its width, points and colours
void draw_crossings(const fiber::FiberAssembly& fibers, const CrossingDrawing& drawing,
                    double thickness, visualization_msgs::Marker& marker);

}  // namespace fiber_proximity_ros
