#pragma once

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/environment/shape_contact_time.hpp"
#include "src/environment/world_shape.hpp"

namespace fiber {

/// A fibre's segment, both ends of which move linearly, and a shape that may move as well.
struct SegmentAndShape {
  Capsule before;
  Capsule after;
  const WorldShape& shape;
};

/// The first contact of their motion: as contact_time() of an axis and a shape. Where the shape
/// turns, the motion is halved, the earlier half first, until the axis moves nearly straight in the
/// shape's frame or is proven to be free.
/// @param distance  [m] of the segment's axis from the shape, at most which there is contact
/// @param tolerance [m] where the shape turns, more than 0: otherwise it would be halved for ever
ContactTime contact_time(const SegmentAndShape& pair, double distance, double tolerance);

}  // namespace fiber
