#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "fiber_proximity/query/engine.hpp"

namespace fiber {

/// The k segments of the engine's fibres whose surfaces are nearest to a point, or all of them if
/// there are fewer; nearest first, ties by fibre and segment.
///
/// In the contacts b is the segment and a the point: `fiber_a`, `segment_a` and `s` are 0,
/// `point_a` is the point, `distance` is negative inside the segment [m]. The same as a LIMITED
/// query about a shape that is this point, without a margin.
/// @param point [m]
/// @param k     at least 1
/// @throws std::invalid_argument naming what is wrong: k of 0, a coordinate that is not finite or
///         above FiberAssembly::max_coordinate
/// @throws std::logic_error before the engine's first update
void nearest_segments(const ProximityEngine& engine, const Eigen::Vector3d& point, std::uint32_t k,
                      QueryResult& result);

}  // namespace fiber
