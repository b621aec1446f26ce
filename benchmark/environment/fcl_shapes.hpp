#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <memory>

#include "fiber_proximity/environment/shapes.hpp"

namespace fiber {

/// A shape as FCL has it; a mesh as a tree of OBBRSS, as FCL's users make them.
/// @throws std::invalid_argument for an unbounded one, whose distance FCL does not know, and for
///         octrees
std::shared_ptr<fcl::CollisionGeometryd> fcl_shape(const Shape& shape);

}  // namespace fiber
