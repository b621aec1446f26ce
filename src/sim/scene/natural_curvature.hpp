#pragma once

#include "fiber_proximity/sim/scene/description.hpp"

namespace fiber {

/// Reads the options of the effect `bend`:
///   natural_curvature: [1/m], or from_shape: that which each fibre begins with; 0 if there is none
///   towards:           a direction, to which side the first edge of each fibre bends; to any side
///                      if there is none
/// @throws std::invalid_argument naming file, line, field and value, and what is allowed
SimCurvature read_natural_curvature(const YamlField& bend, bool has_twist);

/// Gives rods the natural curvature of a scene.
/// @param rods with twist, they have their frames already
/// @throws std::invalid_argument naming file, line and fibre, for a fibre that does not have the
///         side to which it is to bend
void set_natural_curvature(const SimDescription& scene, Rods& rods);

}  // namespace fiber
