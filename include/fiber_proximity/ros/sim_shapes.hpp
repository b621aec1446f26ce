#pragma once

#include <Eigen/Core>
#include <vector>

#include "fiber_proximity/ros/yaml_field.hpp"

namespace fiber_proximity_ros {

/// Reads a `shape` and gives the points of a fibre along it, at equal arc lengths:
///   line:     {from, to}
///   arc:      {from, to, length, towards}     a circular arc, longer than it spans, that sags
///                                             towards a direction
///   helix:    {center, radius, pitch, turns}  about z, from the center up
///   polyline: [point, ...]
///   trefoil:  {center, size}                  an overhand knot about so wide, its ends up and
///   apart
///                                             along x
/// @param segments at least 1
/// @returns segments + 1 points [m]
/// @throws std::invalid_argument naming file, line, field and value, and what is allowed
std::vector<Eigen::Vector3d> read_sim_shape(const YamlField& shape, std::int64_t segments);

}  // namespace fiber_proximity_ros
