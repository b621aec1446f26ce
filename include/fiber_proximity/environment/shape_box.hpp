#pragma once

#include <Eigen/Geometry>

#include "fiber_proximity/environment/shapes.hpp"

namespace fiber {

/// Axis-aligned box in double precision [m].
using WorldBox = Eigen::AlignedBox3d;

/// Smallest box around a solid with this pose, rounded outwards; around a mesh or octree one that
/// need not be the smallest. Infinite along all axes for planes and half-spaces.
WorldBox world_box(const Shape& shape, const Eigen::Isometry3d& pose);

/// Whether the shape ends somewhere: planes and half-spaces do not.
bool is_bounded(const Shape& shape);

}  // namespace fiber
