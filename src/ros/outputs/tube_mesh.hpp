#pragma once

#include <geometry_msgs/Point.h>

#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/ros/outputs/tube_sweep.hpp"

namespace fiber_proximity_ros {

/// Number of corners around a tube.
constexpr int tube_sides = 8;

/// Appends a fibre's surface as triangles, three points each [m], for a TRIANGLE_LIST marker.
///
/// Every corner lies at the segment's exact radius from the axis; half spheres close the ends, so
/// the mesh is inscribed in the capsules the queries are about. The corners run along the fibre
/// without twist (rotation-minimising frames). Points that coincide and chains that fold back are
/// fine. A fibre of radius 0 is drawn with `hairline_radius`, to be seen at all.
/// @param fiber index below fibers.fiber_count()
void append_tube(const fiber::FiberAssembly& fibers, std::uint32_t fiber,
                 std::vector<geometry_msgs::Point>& triangles);

}  // namespace fiber_proximity_ros
