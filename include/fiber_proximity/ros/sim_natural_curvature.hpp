#pragma once

#include <vector>

#include "fiber_proximity/ros/sim_fibers.hpp"

namespace fiber_proximity_ros {

/// Reads the options of the effect `bend`, and gives rods the natural curvature that they name:
///   natural_curvature: [1/m], or from_shape: that which each fibre begins with; 0 if there is none
///   towards:           a direction, to which side the first edge of each fibre bends; to any side
///                      if there is none
/// @param rods those of the fibres; with twist, they have their frames already
/// @throws std::invalid_argument naming file, line, field and value, and what is allowed
void read_natural_curvature(const YamlField& bend, const std::vector<SimFiber>& fibers,
                            fiber::Rods& rods);

}  // namespace fiber_proximity_ros
