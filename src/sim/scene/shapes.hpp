#pragma once

#include <Eigen/Core>
#include <vector>

#include "fiber_proximity/yaml/yaml_field.hpp"

namespace fiber {

/// Reads a `shape`:
///   line:     {from, to}
///   arc:      {from, to, length, towards}     a circular arc, longer than it spans, that sags
///                                             towards a direction
///   helix:    {center, radius, pitch, turns}  about z, from the center up
///   polyline: [point, ...]
///   trefoil:  {center, size}                  an overhand knot about so wide, its ends up and
///                                             apart along x
/// @returns a polyline that is the curve, or as fine as to be measured for it [m]
/// @throws std::invalid_argument naming file, line, field and value, and what is allowed
std::vector<Eigen::Vector3d> read_shape(const YamlField& shape);

/// Points along a polyline at equal arc lengths, its ends among them; all at its beginning if it
/// has no length.
/// @param segments at least 1
/// @returns segments + 1 points [m]
std::vector<Eigen::Vector3d> resample(const std::vector<Eigen::Vector3d>& line,
                                      std::int64_t segments);

}  // namespace fiber
